/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_FOCAL_STACK_MUX (gst_focal_stack_mux_get_type())
G_DECLARE_FINAL_TYPE(GstFocalStackMux, gst_focal_stack_mux, GST, FOCAL_STACK_MUX, GstElement)

GST_ELEMENT_REGISTER_DECLARE(focalstackmux)

G_END_DECLS
