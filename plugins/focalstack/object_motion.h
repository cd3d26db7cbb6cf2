/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/object_rims.h"

namespace dff {

/* How the objects of one sweep move, in the part of the small pictures where any are. */
struct ObjectMotion {
    cv::Rect where;      /* in small pictures; empty if nothing moves */
    cv::Mat2f velocity;  /* pixels of the small pictures from plane to plane, at the middle of the sweep */
    cv::Mat1f objects;   /* how surely a pixel belongs to an object at the middle of the sweep, 0 to 1, not
                            clipped */
    cv::Mat1b stands;    /* differs from the background in each plane and is no moving object: it has
                            stopped, or what moved away was taken for background */
    double farthest = 0; /* largest velocity of any object */
    ObjectRims rims;     /* empty if there are no objects */
};

/* Velocity: dense flow (Kroeger 2016) of pictures in which the background is painted out, between the middle
 * plane and planes two away, whose blur is alike; believed inside the middle plane's silhouettes and spread
 * over the objects. A pixel belongs to an object where its path through the sweep lies in the silhouettes of
 * nine tenths of the planes. */
ObjectMotion find_motion(const SmallStack &sweep, const StillBackground &background,
                         const StillBackground::Noise &noise);

/* Planes after the first one at which a followed sweep is seen. */
constexpr double middle_of_sweep(unsigned planes)
{
    return (planes - 1) / 2.0;
}

} // namespace dff
