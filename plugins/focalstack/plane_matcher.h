/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace dff {

/* A plane made ready for matching: band-passed luma of normalised contrast, its pyramid and its corners. */
class MatchablePlane {
public:
    /* `picture` has 8 or 16 bits and 1, 3 or 4 channels; of 4 the last is ignored. It is reduced by a whole
     * factor until neither side exceeds `max_side` pixels. */
    MatchablePlane(const cv::Mat &picture, int max_side);

    cv::Size size() const { return pyramid_.front().size(); }
    const std::vector<cv::Mat> &pyramid() const { return pyramid_; }

    /* Points worth looking for in another plane; none where there is no texture. */
    const std::vector<cv::Point2f> &corners() const { return corners_; }

private:
    std::vector<cv::Mat> pyramid_;
    std::vector<cv::Point2f> corners_;
};

/* Points of one plane and where they were found in another, in reduced pixels from the centre. Without points
 * if the planes show no shift, turn and zoom that can be trusted. */
struct PlaneMatch {
    std::vector<cv::Point2d> from;
    std::vector<cv::Point2d> to;

    bool trusted() const { return !from.empty(); }
};

/* Follows the corners of `from` into `to`, a plane of the same size. A similarity that most of them agree on
 * (RANSAC) leaves out what moved by itself or was followed astray. */
PlaneMatch match_planes(const MatchablePlane &from, const MatchablePlane &to);

} // namespace dff
