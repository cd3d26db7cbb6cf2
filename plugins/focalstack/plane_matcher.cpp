/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/plane_matcher.h"

#include "focalstack/shift_rivals.h"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace dff {
namespace {

/* Wide enough to bridge the difference in blur, narrow enough to keep what lies at other depths out. */
const cv::Size window{17, 17};
constexpr int pyramid_levels = 2;
constexpr int max_corners = 140;

/* Above this size corners are looked for at half of it, where they are as good and cost a quarter. */
constexpr int detail_side = 200;

/* The band that is matched, sigmas in pixels. The lower one suppresses noise. The upper one favours what is
 * in focus: a blurred foreground grows over its edges, and its corners wander with it. */
constexpr double fine_sigma = 1.0;
constexpr double coarse_sigma = 4.0;

/* Pixels: how far off a corner may come back, and how far off the common warp it may lie. */
constexpr double max_round_trip = 0.5;
constexpr double max_inlier_distance = 1.0;
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

/* Band-passed luma in 8 bits, three standard deviations to either side of 128. */
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

std::vector<cv::Point2f> find_corners(const cv::Mat &picture)
{
    const double spacing = std::sqrt(static_cast<double>(picture.total()) / (2.0 * max_corners));
    std::vector<cv::Point2f> corners;

    cv::goodFeaturesToTrack(picture, corners, max_corners, 0.01, spacing, cv::noArray(), 5);
    return corners;
}

/* The same where pixels are half as large. */
std::vector<cv::Point2f> find_corners_at_half_size(const cv::Mat &picture)
{
    cv::Mat half;
    cv::resize(picture, half, {}, 0.5, 0.5, cv::INTER_AREA);

    std::vector<cv::Point2f> corners = find_corners(half);
    for (cv::Point2f &corner : corners)
        corner = 2.0F * corner + cv::Point2f(0.5F, 0.5F);
    return corners;
}

/* By the phases of their spectra. */
PlaneWarp common_shift(const MatchablePlane &from, const MatchablePlane &to)
{
    cv::Mat a, b, window_function;
    from.band().convertTo(a, CV_32F, 1.0, -128.0);
    to.band().convertTo(b, CV_32F, 1.0, -128.0);
    cv::createHanningWindow(window_function, a.size(), CV_32F);

    const cv::Point2d shift = cv::phaseCorrelate(a, b, window_function);
    return {1.0, 0.0, shift.x, shift.y};
}

bool is_plausible(const PlaneWarp &warp, cv::Size size)
{
    return std::abs(warp.scale() - 1.0) < max_zoom && std::abs(warp.rotation()) < max_rotation &&
           cv::norm(warp.shift()) < max_shift * std::max(size.width, size.height);
}

std::optional<PlaneWarp> common_motion(const PlaneMatch &match, cv::Size size)
{
    if (match.from.size() < min_matches)
        return {};

    std::vector<uchar> inlier;
    const cv::Mat1d affine =
        cv::estimateAffinePartial2D(match.from, match.to, inlier, cv::RANSAC, max_inlier_distance);
    const auto inliers = static_cast<std::size_t>(cv::countNonZero(inlier));
    if (affine.empty() || inliers < min_matches || inliers < min_inlier_share * match.from.size())
        return {};

    const PlaneWarp warp(affine(0, 0), affine(1, 0), affine(0, 2), affine(1, 2));
    return is_plausible(warp, size) ? std::optional(warp) : std::nullopt;
}

} // namespace

cv::Mat reduced_luma(const cv::Mat &picture, int side)
{
    cv::Mat result = picture;

    /* A whole factor first, for which OpenCV is several times faster. */
    const int factor = std::max(picture.cols, picture.rows) / side;
    if (factor > 1)
        cv::resize(result, result, result.size() / factor, 0.0, 0.0, cv::INTER_AREA);
    luma_of(result).convertTo(result, CV_32F);

    const double rest = static_cast<double>(side) / std::max(result.cols, result.rows);
    if (rest < 1.0)
        cv::resize(result, result, {}, rest, rest, cv::INTER_AREA);
    return result;
}

MatchablePlane::MatchablePlane(const cv::Mat &luma)
{
    const cv::Mat band = normalised_band(luma);

    cv::buildOpticalFlowPyramid(band, pyramid_, window, pyramid_levels);
    corners_ =
        std::max(band.cols, band.rows) > detail_side ? find_corners_at_half_size(band) : find_corners(band);
}

PlaneMatch follow_corners(const MatchablePlane &from, const MatchablePlane &to, const PlaneWarp &guess,
                          bool close)
{
    const cv::TermCriteria criteria{cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 10, 0.01};
    const cv::Point2d centre{(from.size().width - 1) / 2.0, (from.size().height - 1) / 2.0};
    std::vector<cv::Point2f> there, back = from.corners();
    std::vector<uchar> found_there, found_back;
    PlaneMatch match;

    if (from.corners().empty())
        return match;
    for (const cv::Point2f corner : from.corners())
        there.emplace_back(guess.apply(cv::Point2d(corner) - centre) + centre);
    cv::calcOpticalFlowPyrLK(from.pyramid(), to.pyramid(), from.corners(), there, found_there, cv::noArray(),
                             window, close ? 0 : pyramid_levels, criteria, cv::OPTFLOW_USE_INITIAL_FLOW);
    /* On the way back the finest level is enough: it is known where it should end. */
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

std::optional<PlaneWarp> find_motion(const MatchablePlane &from, const MatchablePlane &to, PlaneMatch &match)
{
    PlaneWarp guess = common_shift(from, to);

    /* Where a rival wins, it is worth one look of its own. A pattern that repeats confuses phases and
     * pyramids alike: then standing still is worth one too. */
    for (int attempt = 0; attempt < 3; attempt++) {
        const bool still = attempt == 2;
        match = follow_corners(from, to, still ? PlaneWarp() : guess, still);
        const std::optional<PlaneWarp> motion = common_motion(match, from.size());
        if (!motion)
            continue;
        const ShiftRival rival = strongest_rival(from.band(), to.band(), *motion);
        if (!rival.wins(*motion, from.size()))
            return motion;
        guess = PlaneWarp(motion->matrix() * PlaneWarp(1.0, 0.0, rival.shift.x, rival.shift.y).matrix());
    }
    return {};
}

} // namespace dff
