/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "depthio/picture_view.h"
#include "optics/camera_calibration.h"

#include <span>
#include <vector>

namespace dff {

/* How far each depth pixel may be off: one standard deviation in pixels, 0 where it is unknown, and how many
 * metres one pixel makes at each depth pixel there can be, see distance_slope_table(). */
struct DepthUncertainty {
    PictureView deviations;
    std::span<const float> slopes;
};

/* The points that a camera sees, as a binary little-endian PLY file: x right, y down, z away from the camera,
 * with red, green, blue; in metres, or in micrometres for a camera whose rays are parallel. With an
 * uncertainty each has one standard deviation of z too, NaN where it is unknown. */
class PointCloud {
public:
    /* Looks at every `stride`th pixel of every `stride`th row of the camera's pictures. */
    PointCloud(const CameraCalibration &camera, unsigned stride);

    /* Of a telecentric camera, as a microscope is: pixels are `pixel_size_um` micrometres apart in the scene
     * at every distance; x and y are 0 in the picture's centre. */
    static PointCloud orthographic(unsigned width, unsigned height, double pixel_size_um, unsigned stride);

    /* The file of a depth picture of the camera's size; `distances` holds the metres along the axis of each
     * depth pixel there can be, see distance_table(). Pixels without a finite distance up to `max_distance`
     * give no point, nor do those at or behind a camera that is not orthographic. */
    std::vector<uint8_t> write(const PictureView &colour, const PictureView &depth,
                               std::span<const float> distances, double max_distance,
                               const DepthUncertainty *uncertainty = nullptr) const;

private:
    struct Ray {
        float x, y; /* at 1 m along the axis; micrometres where rays are parallel */
    };
    struct Point {
        float x, y, z;
    };

    PointCloud(unsigned width, unsigned stride)
        : orthographic_(true), stride_(stride), columns_((width + stride - 1) / stride)
    {
    }

    bool shows(float distance, double max_distance) const;
    Point point(const Ray &ray, float distance) const;
    float deviation(const DepthUncertainty &uncertainty, uint16_t depth, unsigned x, unsigned y) const;

    bool orthographic_ = false;
    unsigned stride_;
    unsigned columns_;
    std::vector<Ray> rays_;
};

} // namespace dff
