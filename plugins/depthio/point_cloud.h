/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "depthio/picture_view.h"
#include "optics/camera_calibration.h"

#include <span>
#include <vector>

namespace dff {

/* The points that a camera sees, as a binary little-endian PLY file: x right, y down, z away from the camera,
 * in metres, with red, green, blue. */
class PointCloud {
public:
    /* Looks at every `stride`th pixel of every `stride`th row of the camera's pictures. */
    PointCloud(const CameraCalibration &camera, unsigned stride);

    /* The file of a depth picture of the camera's size; `distances` holds the metres along the axis of each
     * depth pixel there can be, see distance_table(). Pixels without a finite distance above 0 and up to
     * `max_distance` give no point. */
    std::vector<uint8_t> write(const PictureView &colour, const PictureView &depth,
                               std::span<const float> distances, double max_distance) const;

private:
    struct Ray {
        float x, y; /* at 1 m along the axis */
    };

    unsigned stride_;
    unsigned columns_;
    std::vector<Ray> rays_;
};

} // namespace dff
