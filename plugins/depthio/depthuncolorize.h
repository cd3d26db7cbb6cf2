/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/video/gstvideofilter.h>
#include <gst/video/video.h>

G_BEGIN_DECLS

#define GST_TYPE_DEPTH_UNCOLORIZE (gst_depth_uncolorize_get_type())
G_DECLARE_FINAL_TYPE(GstDepthUncolorize, gst_depth_uncolorize, GST, DEPTH_UNCOLORIZE, GstVideoFilter)

GST_ELEMENT_REGISTER_DECLARE(depthuncolorize)

G_END_DECLS
