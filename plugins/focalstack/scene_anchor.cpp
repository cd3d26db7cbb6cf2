/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/scene_anchor.h"

#include "focalstack/stack_aligner.h"

#include <array>
#include <cmath>

namespace dff {

namespace {

constexpr double most_rest = 4.0;   /* pixels: so far a plane goes on beyond its border, see fill_hidden() */
constexpr double most_fault = 1.5;  /* pixels that the shift may be off before it changes: 1 would do */
constexpr double most_share = 0.25; /* of the picture, by which it may shift */

/* The nearest even number, or the one before if that is not much farther. */
int even_shift(double wanted, int before)
{
    return std::abs(wanted - before) <= most_fault ? before : 2 * cvRound(wanted / 2.0);
}

} // namespace

PlaneWarp SceneAnchor::anchor(const cv::Mat &picture)
{
    picture.copyTo(anchor_);
    shift_ = {};
    anchors_++;
    return {};
}

PlaneWarp SceneAnchor::rest_of(const cv::Mat &picture)
{
    if (anchor_.size() != picture.size() || anchor_.type() != picture.type())
        return anchor(picture);
    const std::array planes{picture, anchor_}; /* the middle one of two is the second */
    const PlaneAlignment found = align_stack(planes, MotionModel::Similarity).front();
    if (!found.trusted)
        return anchor(picture);
    const cv::Point2d moved = found.warp.shift();
    shift_ = {even_shift(-moved.x, shift_.x), even_shift(-moved.y, shift_.y)};
    const PlaneWarp rest(found.warp.matrix() * PlaneWarp(1.0, 0.0, shift_.x, shift_.y).matrix());
    if (rest.largest_shift(picture.size()) > most_rest || std::abs(shift_.x) > most_share * picture.cols ||
        std::abs(shift_.y) > most_share * picture.rows)
        return anchor(picture);
    return rest;
}

} // namespace dff
