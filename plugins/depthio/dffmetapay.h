/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/base/gstbasetransform.h>

G_BEGIN_DECLS

#define GST_TYPE_DFF_META_PAY (gst_dff_meta_pay_get_type())
G_DECLARE_FINAL_TYPE(GstDffMetaPay, gst_dff_meta_pay, GST, DFF_META_PAY, GstBaseTransform)

GST_ELEMENT_REGISTER_DECLARE(dffmetapay)

G_END_DECLS
