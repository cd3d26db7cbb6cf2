/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace dff {

/* Where a camera looks that pans and is held by a hand. Beyond the borders of the scene's picture the world
 * goes on as its mirror image. */
class CameraMotion {
public:
    /* Pixels that it turns to the right from plane to plane, and root mean square of a hand's shake along x
     * and y, in pixels. */
    CameraMotion(double pan, double shake, uint64_t seed);

    bool is_still() const { return pan_ == 0.0 && shake_ == 0.0; }

    /* What is seen in the picture's corner, `time` planes after the start, in pixels of the scene. */
    cv::Point2d offset(double time) const;

    /* Pixels a plane. */
    cv::Vec2d velocity(double time) const;

private:
    double shake(double time, uint64_t axis) const;

    double pan_, shake_;
    uint64_t seed_;
};

/* A place of the mirrored world as a pixel of the picture of `length` pixels, and whether it is seen
 * mirrored. */
struct WorldPixel {
    int at;
    bool is_mirrored;
};
WorldPixel world_pixel(double place, int length);

} // namespace dff
