/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_FOCAL_STACK_DEMUX (gst_focal_stack_demux_get_type())
G_DECLARE_FINAL_TYPE(GstFocalStackDemux, gst_focal_stack_demux, GST, FOCAL_STACK_DEMUX, GstElement)

GST_ELEMENT_REGISTER_DECLARE(focalstackdemux)

G_END_DECLS
