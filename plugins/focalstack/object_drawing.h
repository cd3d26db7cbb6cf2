/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace dff {

/* Pixels of a component's picture that objects cover in the middle of the sweep, how they move, and what they
 * look like. */
struct ObjectsOfComponent {
    cv::Rect where;
    cv::Rect part;      /* the same of the pictures of ObjectMotion */
    int side;           /* pixels of the component a pixel of the small pictures */
    cv::Mat2f velocity; /* a plane */
    cv::Mat1f objects;  /* 0 to 1, not clipped */
    cv::Mat1f plain;    /* as of ObjectRims */
    std::vector<cv::Mat1f> colours;
};

/* Blends `over` into the picture by `share`, 0 to 1 or beyond. */
void blend(const cv::Mat &picture, const cv::Mat &over, const cv::Mat1f &share);

/* What one plane shows of them, and around them, of the same pixels. */
struct PlaneOfObjects {
    cv::Mat moved;          /* seen where they are in the middle of the sweep */
    cv::Mat behind;         /* the background that moved with them */
    cv::Mat1f share, noisy; /* as of ObjectRims */
};

/* Draws the objects of one plane, into `picture` of the pixels `objects.where`.
 *
 * At its blurred rim an object lets through what is behind. Where it has texture, which tells its depth, its
 * own colour takes the place of that, and it ends at its outline: blur over the background would hide how
 * deep that lies. Of an object without texture nothing but the blur of its rim tells the depth: that stays,
 * and shows the background of the new place. Its noise would pass for texture beside a background that is
 * averaged: it gets its own smooth colour instead. */
void draw_objects(const cv::Mat &picture, const PlaneOfObjects &plane, const ObjectsOfComponent &objects);

} // namespace dff
