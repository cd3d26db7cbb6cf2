/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/dff-prelude.h>

G_BEGIN_DECLS

/**
 * GST_DFF_DEVICE_CONTEXT_TYPE:
 *
 * Type of the #GstContext by which elements share an OpenCL device. Its field "device" (string) is part of
 * the device's name, as for the elements' property `device`. Contexts that elements made also have the field
 * "gst.dff.opencl.device", the open device itself: hand them to other pipelines as they are.
 *
 * Since: 0.1
 */
#define GST_DFF_DEVICE_CONTEXT_TYPE "gst.dff.opencl.device"

GST_DFF_API GstContext *gst_context_new_dff_device(const gchar *device);

G_END_DECLS
