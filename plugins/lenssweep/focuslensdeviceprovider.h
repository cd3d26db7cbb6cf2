/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_FOCUS_LENS_DEVICE (gst_focus_lens_device_get_type())
G_DECLARE_FINAL_TYPE(GstFocusLensDevice, gst_focus_lens_device, GST, FOCUS_LENS_DEVICE, GstDevice)

#define GST_TYPE_FOCUS_LENS_DEVICE_PROVIDER (gst_focus_lens_device_provider_get_type())
G_DECLARE_FINAL_TYPE(GstFocusLensDeviceProvider, gst_focus_lens_device_provider, GST,
                     FOCUS_LENS_DEVICE_PROVIDER, GstDeviceProvider)

GST_DEVICE_PROVIDER_REGISTER_DECLARE(focuslensdeviceprovider)

G_END_DECLS
