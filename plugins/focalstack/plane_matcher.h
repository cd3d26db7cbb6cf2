/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "focalstack/plane_warp.h"

namespace dff {

/* Luma in 32 bits, reduced until neither side exceeds `side` pixels. `picture` has 8, 16 or 32 bits and 1, 3
 * or 4 channels; of 4 the last is ignored. */
cv::Mat reduced_luma(const cv::Mat &picture, int side);

/* A plane made ready for matching at one size: band-passed luma of normalised contrast, its pyramid and its
 * corners. */
class MatchablePlane {
public:
    /* `luma` as reduced_luma() gives it. */
    explicit MatchablePlane(const cv::Mat &luma);

    cv::Size size() const { return band().size(); }
    const cv::Mat &band() const { return pyramid_.front(); }
    const std::vector<cv::Mat> &pyramid() const { return pyramid_; }

    /* The same plane after a turn about its centre, in radians as PlaneWarp's; grey where it shows nothing.
     */
    MatchablePlane turned_by(double angle) const;

    /* Points worth looking for in another plane; none where there is no texture. */
    const std::vector<cv::Point2f> &corners() const { return corners_; }

private:
    MatchablePlane() = default;
    void prepare(const cv::Mat &band);

    std::vector<cv::Mat> pyramid_;
    std::vector<cv::Point2f> corners_;
};

/* Points of one plane and where they were found in another, in pixels from the centre. */
struct PlaneMatch {
    std::vector<cv::Point2d> from;
    std::vector<cv::Point2d> to;
};

/* Fewer points than these say nothing: corners of pure noise agree on a warp to about a tenth. */
constexpr std::size_t min_matches = 16;

/* Follows the corners of `from` into `to`, a plane of the same size, by Lucas-Kanade, and keeps those that
 * lead back. `guess` says where in `to` they may be expected: to about 20 pixels, or, if it is `close`, to 5.
 */
PlaneMatch follow_corners(const MatchablePlane &from, const MatchablePlane &to, const PlaneWarp &guess,
                          bool close);

/* How the picture of `from` is shifted, turned and zoomed in `to`, from nothing known: the shift is read from
 * the phases of the spectra, as is, where that leads nowhere, a turn of up to 16 degrees; the rest is what
 * most corners that are followed from there agree on (RANSAC). Nothing if too few agree, if no hand and no
 * lens does the like, or if another shift explains `to` better, as happens on patterns that repeat. `match`
 * gets all corners that were followed. */
std::optional<PlaneWarp> find_motion(const MatchablePlane &from, const MatchablePlane &to, PlaneMatch &match);

} // namespace dff
