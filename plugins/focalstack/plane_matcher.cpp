/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/plane_matcher.h"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace dff {
namespace {

/* Wide enough to bridge the difference in blur, narrow enough to keep what lies at other depths out. */
const cv::Size window{21, 21};
constexpr int pyramid_levels = 4;
constexpr int max_corners = 500;

/* The band that is matched, sigmas in reduced pixels. The lower one suppresses noise. The upper one favours
 * what is in focus: a blurred foreground grows over its edges, and its corners wander with it. */
constexpr double fine_sigma = 1.0;
constexpr double coarse_sigma = 4.0;

/* Reduced pixels: how far off a corner may come back, and how far off the common similarity it may lie. */
constexpr double max_round_trip = 0.5;
constexpr double max_inlier_distance = 1.0;

/* Corners of pure noise agree on a similarity to about a tenth. */
constexpr std::size_t min_inliers = 16;
constexpr double min_inlier_share = 0.4;

/* No hand and no lens does more between two planes. */
constexpr double max_zoom = 0.15;
constexpr double max_rotation = 0.1; /* radians */
constexpr double max_shift = 0.2;    /* of the longer side */

/* R/4 + G/2 + B/4, which does not ask which end red is at. */
cv::Mat luma_of(const cv::Mat &picture)
{
    static const cv::Matx14f weights{0.25F, 0.5F, 0.25F, 0.0F};
    cv::Mat luma;

    if (picture.channels() == 1)
        luma = picture;
    else
        cv::transform(picture, luma, cv::Mat(weights).colRange(0, picture.channels()));
    return luma;
}

/* Band-passed luma in 8 bits, three standard deviations to either side. */
cv::Mat normalised_band(const cv::Mat &luma)
{
    cv::Mat fine, coarse, band;
    cv::GaussianBlur(luma, fine, {}, fine_sigma);
    cv::GaussianBlur(luma, coarse, {}, coarse_sigma);
    cv::subtract(fine, coarse, band);

    cv::Scalar mean, deviation;
    cv::meanStdDev(band, mean, deviation);
    const double gain = deviation[0] > 0.0 ? 42.0 / deviation[0] : 0.0;
    band.convertTo(band, CV_8U, gain, 128.0);
    return band;
}

/* `affine` acts on pixels from the centre. */
bool is_plausible(const cv::Matx23d &affine, cv::Size size)
{
    const double shift = std::hypot(affine(0, 2), affine(1, 2));
    const double scale = std::hypot(affine(0, 0), affine(1, 0));
    const double rotation = std::atan2(affine(1, 0), affine(0, 0));

    return std::abs(scale - 1.0) < max_zoom && std::abs(rotation) < max_rotation &&
           shift < max_shift * std::max(size.width, size.height);
}

/* Where each corner of `from` lies in `to`, by pyramidal Lucas-Kanade there and back again. */
PlaneMatch follow_corners(const MatchablePlane &from, const MatchablePlane &to)
{
    const cv::TermCriteria criteria{cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 20, 0.01};
    const cv::Point2d centre{(from.size().width - 1) / 2.0, (from.size().height - 1) / 2.0};
    std::vector<cv::Point2f> there, back;
    std::vector<uchar> found_there, found_back;
    PlaneMatch match;

    cv::calcOpticalFlowPyrLK(from.pyramid(), to.pyramid(), from.corners(), there, found_there, cv::noArray(),
                             window, pyramid_levels, criteria);
    /* On the way back the finest level is enough: it is known where it should end. */
    back = from.corners();
    cv::calcOpticalFlowPyrLK(to.pyramid(), from.pyramid(), there, back, found_back, cv::noArray(), window, 0,
                             criteria, cv::OPTFLOW_USE_INITIAL_FLOW);

    for (std::size_t i = 0; i < there.size(); i++) {
        if (!found_there[i] || !found_back[i] || cv::norm(back[i] - from.corners()[i]) > max_round_trip)
            continue;
        match.from.push_back(cv::Point2d(from.corners()[i]) - centre);
        match.to.push_back(cv::Point2d(there[i]) - centre);
    }
    return match;
}

} // namespace

MatchablePlane::MatchablePlane(const cv::Mat &picture, int max_side)
{
    const int longer_side = std::max(picture.cols, picture.rows);
    const int factor = (longer_side + max_side - 1) / max_side;
    cv::Mat luma;

    luma_of(picture).convertTo(luma, CV_32F);
    if (factor > 1)
        cv::resize(luma, luma, luma.size() / factor, 0.0, 0.0, cv::INTER_AREA);

    const cv::Mat band = normalised_band(luma);
    const double spacing = std::sqrt(static_cast<double>(band.total()) / (2.0 * max_corners));
    cv::buildOpticalFlowPyramid(band, pyramid_, window, pyramid_levels);
    cv::goodFeaturesToTrack(band, corners_, max_corners, 0.01, spacing, cv::noArray(), 5);
}

PlaneMatch match_planes(const MatchablePlane &from, const MatchablePlane &to)
{
    if (from.corners().size() < min_inliers)
        return {};

    const PlaneMatch followed = follow_corners(from, to);
    if (followed.from.size() < min_inliers)
        return {};

    std::vector<uchar> inlier;
    const cv::Mat affine =
        cv::estimateAffinePartial2D(followed.from, followed.to, inlier, cv::RANSAC, max_inlier_distance);
    const auto inliers = static_cast<std::size_t>(cv::countNonZero(inlier));
    if (affine.empty() || inliers < min_inliers || inliers < min_inlier_share * followed.from.size() ||
        !is_plausible(affine, from.size()))
        return {};

    PlaneMatch match;
    for (std::size_t i = 0; i < inlier.size(); i++) {
        if (!inlier[i])
            continue;
        match.from.push_back(followed.from[i]);
        match.to.push_back(followed.to[i]);
    }
    return match;
}

} // namespace dff
