/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/moving_thing.h"
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

/* Lets things fly through a scene that stands still: what of it lies behind, between and before their paths
 * is rendered once a plane, then each frame blurs the things alone and puts them between. */
class MovingOverlay {
public:
    /* `things` are there from far to near; `depth_to_position` is the plane position of depth 1. Unusable
     * where `stop` was requested. */
    MovingOverlay(const ThinLensRenderer &renderer, std::vector<MovingThing> things,
                  const std::vector<PlaneView> &views, double depth_to_position, const std::stop_token &stop);

    const std::vector<MovingThing> &things() const { return things_; }

    /* The part of a plane's picture that the things change, `time` planes after the start; empty where the
     * lens shows none of them. */
    PicturePatch patch(unsigned plane, double time) const;

private:
    struct Band {
        PlaneView view;
        cv::Rect where;
        std::vector<cv::Mat4f> slabs; /* of the scene: behind the first thing, before it, ...; empty if there
                                         is nothing */
    };

    double blur_of(const Band &band, double depth) const;
    cv::Rect reach_of(const Band &band, const MovingThing &thing, const MovingPose &pose) const;
    cv::Rect rows_of(const Band &band) const;

    std::vector<MovingThing> things_;
    cv::Size picture_;
    double blur_step_;
    double depth_to_position_;
    std::vector<Band> bands_;
};

/* The picture after a warp, mirrored at its border. */
template <typename Pixel> cv::Mat_<Pixel> warp_picture(const cv::Mat_<Pixel> &picture, const PlaneView &view);

} // namespace dff
