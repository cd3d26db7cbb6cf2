/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_DFF_DEPTH (gst_dff_depth_get_type())
G_DECLARE_FINAL_TYPE(GstDffDepth, gst_dff_depth, GST, DFF_DEPTH, GstElement)

GST_ELEMENT_REGISTER_DECLARE(dffdepth)

G_END_DECLS
