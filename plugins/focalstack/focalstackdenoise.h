/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/base/gstbasetransform.h>

G_BEGIN_DECLS

#define GST_TYPE_FOCAL_STACK_DENOISE (gst_focal_stack_denoise_get_type())
G_DECLARE_FINAL_TYPE(GstFocalStackDenoise, gst_focal_stack_denoise, GST, FOCAL_STACK_DENOISE,
                     GstBaseTransform)

GST_ELEMENT_REGISTER_DECLARE(focalstackdenoise)

G_END_DECLS
