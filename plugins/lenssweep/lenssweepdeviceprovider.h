/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_LENS_SWEEP_DEVICE (gst_lens_sweep_device_get_type())
G_DECLARE_FINAL_TYPE(GstLensSweepDevice, gst_lens_sweep_device, GST, LENS_SWEEP_DEVICE, GstDevice)

#define GST_TYPE_LENS_SWEEP_DEVICE_PROVIDER (gst_lens_sweep_device_provider_get_type())
G_DECLARE_FINAL_TYPE(GstLensSweepDeviceProvider, gst_lens_sweep_device_provider, GST,
                     LENS_SWEEP_DEVICE_PROVIDER, GstDeviceProvider)

GST_DEVICE_PROVIDER_REGISTER_DECLARE(lenssweepdeviceprovider)

G_END_DECLS
