/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace dff {

/* A textured ball that flies from side to side, facing the camera, at one depth of the sweep. */
class MovingBall {
public:
    /* Depth within the sweep, 0 near to 1 far. */
    static constexpr double depth = 0.15;

    /* In a picture of this size, with `speed` pixels from one plane to the next. */
    MovingBall(cv::Size picture, double speed, uint64_t seed);

    double radius() const { return radius_; }

    /* Its centre when `time` planes have passed since the start of the first sweep. */
    cv::Point2d center(double time) const;

    /* What it covers of a part of the picture, premultiplied R, G, B and alpha in 0..1: sharp, after `warp`.
     */
    cv::Mat4f draw(double time, const cv::Matx23d &warp, const cv::Rect &where) const;

private:
    cv::Size picture_;
    double speed_;
    double radius_;
    cv::Mat4f sprite_;
};

} // namespace dff
