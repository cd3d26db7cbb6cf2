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
constexpr double max_rotation = 0.3; /* radians */
constexpr double max_shift = 0.2;    /* of the longer side */

/* Radians. Phases and patches bear turns of half of this step; larger ones are looked for in multiples
 * of it. */
constexpr double turn_step = 0.07;
constexpr int most_turns = 4;

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

/* By the phases of the spectra of two bands; `response` is the larger the better they fit. */
PlaneWarp common_shift(const cv::Mat &from, const cv::Mat &to, double *response = nullptr)
{
    cv::Mat a, b, window_function;
    from.convertTo(a, CV_32F, 1.0, -128.0);
    to.convertTo(b, CV_32F, 1.0, -128.0);
    cv::createHanningWindow(window_function, a.size(), CV_32F);

    const cv::Point2d shift = cv::phaseCorrelate(a, b, window_function, response);
    return {1.0, 0.0, shift.x, shift.y};
}

cv::Mat turned(const cv::Mat &band, double angle)
{
    const PlaneWarp turn(std::cos(angle), std::sin(angle), 0.0, 0.0);
    cv::Mat result;

    cv::warpPerspective(band, result, turn.pixel_matrix(band.size()), band.size(), cv::INTER_LINEAR,
                        cv::BORDER_CONSTANT, cv::Scalar::all(128));
    return result;
}

/* The turn after which the phases of `from` fit best to those of `to`. */
double best_turn(const MatchablePlane &from, const MatchablePlane &to)
{
    double best = 0.0, best_response = 0.0;

    for (int i = -most_turns; i <= most_turns; i++) {
        double response = 0.0;
        common_shift(turned(from.band(), i * turn_step), to.band(), &response);
        if (response > best_response) {
            best_response = response;
            best = i * turn_step;
        }
    }
    return best;
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
    prepare(normalised_band(luma));
}

MatchablePlane MatchablePlane::turned_by(double angle) const
{
    MatchablePlane result;

    result.prepare(turned(band(), angle));
    return result;
}

void MatchablePlane::prepare(const cv::Mat &band)
{
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

namespace {

/* What follows the corners of `from` as from `guess` finds, if no other shift explains `to` better. Otherwise
 * `guess` becomes that one. */
std::optional<PlaneWarp> motion_near(const MatchablePlane &from, const MatchablePlane &to, PlaneWarp &guess,
                                     bool close, PlaneMatch &match)
{
    match = follow_corners(from, to, guess, close);
    const std::optional<PlaneWarp> motion = common_motion(match, from.size());
    if (!motion)
        return {};
    const ShiftRival rival = strongest_rival(from.band(), to.band(), *motion);
    if (!rival.wins(*motion, from.size()))
        return motion;
    guess = PlaneWarp(motion->matrix() * PlaneWarp(1.0, 0.0, rival.shift.x, rival.shift.y).matrix());
    return {};
}

/* The same if `from` was turned by more than patches bear. */
std::optional<PlaneWarp> turned_motion(const MatchablePlane &from, const MatchablePlane &to,
                                       PlaneMatch &match)
{
    const double angle = best_turn(from, to);
    if (angle == 0.0)
        return {};

    const MatchablePlane turned_from = from.turned_by(angle);
    const PlaneWarp turn(std::cos(angle), std::sin(angle), 0.0, 0.0);
    PlaneWarp guess = common_shift(turned_from.band(), to.band());
    const std::optional<PlaneWarp> motion = motion_near(turned_from, to, guess, false, match);
    if (!motion)
        return {};
    for (cv::Point2d &point : match.from)
        point = turn.inverse().apply(point);
    const PlaneWarp whole(motion->matrix() * turn.matrix());
    return is_plausible(whole, from.size()) ? std::optional(whole) : std::nullopt;
}

} // namespace

std::optional<PlaneWarp> find_motion(const MatchablePlane &from, const MatchablePlane &to, PlaneMatch &match)
{
    if (from.corners().size() < min_matches)
        return {};
    const PlaneWarp shift = common_shift(from.band(), to.band());
    PlaneWarp guess = shift;

    if (const std::optional<PlaneWarp> motion = motion_near(from, to, guess, false, match))
        return motion;
    /* Where a rival wins, it is worth one look of its own. A pattern that repeats confuses phases and
     * pyramids alike: then standing still is worth one too. */
    if (guess.shift() != shift.shift()) {
        if (const std::optional<PlaneWarp> motion = motion_near(from, to, guess, false, match))
            return motion;
    }
    PlaneWarp still;
    if (const std::optional<PlaneWarp> motion = motion_near(from, to, still, true, match))
        return motion;
    return turned_motion(from, to, match);
}

} // namespace dff
