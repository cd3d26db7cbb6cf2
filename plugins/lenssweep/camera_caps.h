/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "camera/aravis_camera.h"
#include "camera/pixel_layout.h"

#include <gst/gst.h>

/* All that lenssweepsrc may give out; to be unreffed. */
GstCaps *camera_template_caps();

/* What this camera can give, at so many frames a second; its current pixel format first. To be unreffed.
 * Throws dff::CameraError if none of its formats is known. */
GstCaps *camera_caps(dff::AravisCamera &camera, double frame_rate);

/* Picks the camera's own size, or the nearest to it; takes the caps. */
GstCaps *fixate_camera_caps(dff::AravisCamera &camera, GstCaps *caps);

/* What caps ask the camera for. */
struct CameraFormat {
    const dff::PixelLayout *layout = nullptr;
    int width = 0;
    int height = 0;

    bool operator==(const CameraFormat &) const = default;
};

/* Without a layout if the caps are none of ours. */
CameraFormat format_of_caps(dff::AravisCamera &camera, const GstCaps *caps);
