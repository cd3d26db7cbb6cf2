/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/base/gstbasetransform.h>

G_BEGIN_DECLS

#define GST_TYPE_LENS_SWEEP_TAG (gst_lens_sweep_tag_get_type())
G_DECLARE_FINAL_TYPE(GstLensSweepTag, gst_lens_sweep_tag, GST, LENS_SWEEP_TAG, GstBaseTransform)

GST_ELEMENT_REGISTER_DECLARE(lenssweeptag)

G_END_DECLS
