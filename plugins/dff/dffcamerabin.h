/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_DFF_CAMERA_BIN (gst_dff_camera_bin_get_type())
G_DECLARE_FINAL_TYPE(GstDffCameraBin, gst_dff_camera_bin, GST, DFF_CAMERA_BIN, GstBin)

GST_ELEMENT_REGISTER_DECLARE(dffcamerabin)

G_END_DECLS
