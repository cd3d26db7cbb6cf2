/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/moving_ball.h"
#include "engine/scene/thin_lens_renderer.h"

#include <stop_token>
#include <vector>

namespace dff {

/* How one plane is taken: plane position in focus, and the warp of its picture. */
struct PlaneView {
    double focus;
    cv::Matx23d warp;

    bool warped() const { return warp != cv::Matx23d::eye(); }
};

/* Part of a picture, in 8-bit values that are not rounded. */
struct PicturePatch {
    cv::Rect where;
    cv::Mat3f values;
};

/* Lets a ball fly through a scene that stands still: what lies behind its path and what lies before it is
 * rendered once a plane, then each frame blurs the ball alone and puts it between the two. */
class MovingOverlay {
public:
    /* `depth_to_position` is the plane position of depth 1. Unusable where `stop` was requested. */
    MovingOverlay(const ThinLensRenderer &renderer, MovingBall ball, const std::vector<PlaneView> &views,
                  double depth_to_position, const std::stop_token &stop);

    const MovingBall &ball() const { return ball_; }

    /* The part of a plane's picture that the ball changes, `time` planes after the start. */
    PicturePatch patch(unsigned plane, double time) const;

private:
    struct Band {
        PlaneView view;
        double blur; /* of the ball, pixels */
        cv::Rect where;
        cv::Mat4f behind;
        cv::Mat4f before;
    };

    cv::Rect reach_of(const Band &band, const cv::Point2d &center) const;

    MovingBall ball_;
    cv::Size picture_;
    std::vector<Band> bands_;
};

/* The picture after a warp, mirrored at its border. */
template <typename Pixel> cv::Mat_<Pixel> warp_picture(const cv::Mat_<Pixel> &picture, const PlaneView &view);

} // namespace dff
