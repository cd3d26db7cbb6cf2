/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/base/gstbasetransform.h>

G_BEGIN_DECLS

#define GST_TYPE_FOCAL_STACK_ALIGN (gst_focal_stack_align_get_type())
G_DECLARE_FINAL_TYPE(GstFocalStackAlign, gst_focal_stack_align, GST, FOCAL_STACK_ALIGN, GstBaseTransform)

GST_ELEMENT_REGISTER_DECLARE(focalstackalign)

G_END_DECLS
