/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/base/gstbasetransform.h>

G_BEGIN_DECLS

#define GST_TYPE_DFF_META_DEPAY (gst_dff_meta_depay_get_type())
G_DECLARE_FINAL_TYPE(GstDffMetaDepay, gst_dff_meta_depay, GST, DFF_META_DEPAY, GstBaseTransform)

GST_ELEMENT_REGISTER_DECLARE(dffmetadepay)

G_END_DECLS
