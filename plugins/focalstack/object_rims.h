/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/still_background.h"

namespace dff {

/* What the planes of a sweep show around their objects, each seen where it is in the middle of the sweep. All
 * pictures are of one part of the small ones. */
struct ObjectRims {
    std::vector<cv::Mat1f> share;   /* a plane each: part of the light that comes from an object, 0 to 1. The
                                       more a plane is blurred, the more slowly it falls */
    std::vector<cv::Mat1f> colours; /* a channel each: an object's own, smooth, continued beyond it */
    cv::Mat1f plain;                /* of the object that is nearest: 0 has texture, 1 has none */
    std::vector<cv::Mat1f> noisy;   /* a plane each: up to 1 where such an object shows nothing but noise */
};

/* `inside` is where objects are, `velocity` how they move. The share is found at each distance from the
 * outline, for each object and plane, by least squares: how far colours lie on the way from what stands
 * behind to the object's own. `objects` as of ObjectMotion: outlines go where half of the light is an
 * object's. */
ObjectRims find_rims(const SmallStack &sweep, const StillBackground &background, const cv::Rect &where,
                     const cv::Mat1b &inside, const cv::Mat2f &velocity, const StillBackground::Noise &noise,
                     cv::Mat1f &objects);

/* Velocity of objects without texture made more exact, by their outlines in all planes. */
void refine_plain_velocity(const SmallStack &sweep, const StillBackground &background, const cv::Rect &where,
                           const cv::Mat1b &inside, const StillBackground::Noise &noise, cv::Mat2f &velocity);

/* The outline of objects without texture made more exact, by all planes' colours: `objects` as of
 * ObjectMotion, `inside` where they are. */
void refine_plain_outline(const SmallStack &sweep, const StillBackground &background, const cv::Rect &where,
                          const cv::Mat1b &inside, const StillBackground::Noise &noise,
                          const cv::Mat2f &velocity, cv::Mat1f &objects);

} // namespace dff
