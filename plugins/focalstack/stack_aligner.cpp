/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/stack_aligner.h"

#include <algorithm>
#include <array>

#include "focalstack/link_trust.h"
#include "focalstack/plane_matcher.h"

namespace dff {
namespace {

/* Pixels of the longer side that planes are matched at. A size that is less than twice the one before has
 * nothing new to tell. */
constexpr std::array sides{160, 480, 1000};

/* Links over more planes than one keep errors from adding up; beyond eight there is little left in common,
 * and on larger pictures beyond two. */
constexpr std::size_t first_distance = 8;
constexpr std::size_t later_distance = 2;

/* Pixels. Where the points of two planes spread by more than this, they will not agree better on larger
 * pictures. */
constexpr double max_spread_to_go_on = 0.5;

/* A homography is chosen where similarities leave the points of a link this far apart, in pixels that were
 * matched, and homographies at most that share of it. More numbers always explain a little more. */
constexpr double miss_to_explain = 0.1;
constexpr double share_left = 0.8;

class StackMatcher {
public:
    explicit StackMatcher(std::span<const cv::Mat> planes)
        : size_(planes.front().size()), middle_(middle_plane(planes.size())), reached_(planes.size(), false),
          warps_(planes.size())
    {
        for (const cv::Mat &plane : planes)
            lumas_.push_back(reduced_luma(plane, sides.back()));
    }

    void match_smallest();
    void match_larger();
    void choose_model(std::optional<MotionModel> model);
    std::vector<PlaneAlignment> alignments() const;

private:
    /* The planes at one of the sizes. */
    struct Level {
        std::vector<MatchablePlane> planes;
        double pixel;

        cv::Size size() const { return planes.front().size(); }
    };

    Level level_of(int side) const;
    void match_neighbours(const Level &level);
    void find_path(std::size_t from, std::size_t to, const Level &level);
    void spread_from_middle();
    void match_along(const Level &level, std::size_t distance);
    bool is_worth_a_larger_size(std::size_t from, std::size_t to) const;
    bool is_known(std::size_t from, std::size_t to) const;
    void add_link(std::size_t from, std::size_t to, PlaneMatch match, const Level &level);
    void solve(MotionModel model);

    cv::Size size_;
    std::size_t middle_;
    std::vector<cv::Mat> lumas_;
    std::vector<bool> blank_;
    std::vector<bool> reached_; /* from the middle plane, by steps */

    /* How planes that were matched from nothing lie to each other: `warp` brings `from` onto `to`. */
    struct Step {
        std::size_t from;
        std::size_t to;
        PlaneWarp warp;
    };
    std::vector<Step> steps_;

    /* Those of the smallest size that came from nothing say whom to trust: on larger pictures corners wander
     * with the blur, and who follows a guess does not find what contradicts it. */
    std::vector<PlaneLink> links_, links_of_trust_;
    std::vector<PlaneWarp> warps_; /* onto the middle plane */
};

StackMatcher::Level StackMatcher::level_of(int side) const
{
    Level level;

    for (const cv::Mat &luma : lumas_)
        level.planes.emplace_back(reduced_luma(luma, side));
    level.pixel = static_cast<double>(size_.width) / level.size().width;
    return level;
}

void StackMatcher::add_link(std::size_t from, std::size_t to, PlaneMatch match, const Level &level)
{
    const double x = static_cast<double>(size_.width) / level.size().width;
    const double y = static_cast<double>(size_.height) / level.size().height;

    for (std::vector<cv::Point2d> *points : {&match.from, &match.to}) {
        for (cv::Point2d &point : *points)
            point = {point.x * x, point.y * y};
    }
    if (match.from.size() >= min_matches)
        links_.push_back({from, to, std::move(match), level.pixel});
}

void StackMatcher::find_path(std::size_t from, std::size_t to, const Level &level)
{
    PlaneMatch match;

    if (const std::optional<PlaneWarp> motion = find_motion(level.planes[from], level.planes[to], match)) {
        steps_.push_back({from, to, motion->in_picture_larger_by(level.pixel, level.pixel)});
        add_link(from, to, std::move(match), level);
    }
}

bool StackMatcher::is_known(std::size_t from, std::size_t to) const
{
    return std::ranges::any_of(steps_, [&](const Step &step) { return step.from == from && step.to == to; });
}

/* Neighbours, and around a plane that fits neither of its own those on both sides of it. */
void StackMatcher::match_neighbours(const Level &level)
{
    for (std::size_t z = 0; z + 1 < warps_.size(); z++)
        find_path(z, z + 1, level);
    for (std::size_t z = 0; z + 2 < warps_.size(); z++) {
        if (!is_known(z, z + 1) || !is_known(z + 1, z + 2))
            find_path(z, z + 2, level);
    }
}

/* A first guess of all warps, step by step from the middle. Links between planes that no step reaches say
 * nothing of where these lie, and would be satisfied best if all shrank to a point. */
void StackMatcher::spread_from_middle()
{
    bool grown = true;

    reached_[middle_] = true;
    while (grown) {
        grown = false;
        for (const Step &step : steps_) {
            if (reached_[step.from] == reached_[step.to])
                continue;
            if (reached_[step.from])
                warps_[step.to] = PlaneWarp(warps_[step.from].matrix() * step.warp.matrix().inv());
            else
                warps_[step.from] = PlaneWarp(warps_[step.to].matrix() * step.warp.matrix());
            reached_[step.from] = reached_[step.to] = grown = true;
        }
    }
    std::erase_if(links_, [&](const PlaneLink &link) { return !reached_[link.from]; });
}

void StackMatcher::match_along(const Level &level, std::size_t distance)
{
    for (std::size_t z = 0; z + distance < warps_.size(); z++) {
        if (!reached_[z] || !reached_[z + distance])
            continue;
        if (level.pixel < links_.front().pixel ? !is_worth_a_larger_size(z, z + distance)
                                               : is_known(z, z + distance))
            continue;
        const PlaneWarp onto(warps_[z + distance].matrix().inv() * warps_[z].matrix());
        const PlaneWarp guess = onto.in_picture_larger_by(1.0 / level.pixel, 1.0 / level.pixel);
        add_link(z, z + distance, follow_corners(level.planes[z], level.planes[z + distance], guess, true),
                 level);
    }
}

bool StackMatcher::is_worth_a_larger_size(std::size_t from, std::size_t to) const
{
    const auto last = std::find_if(links_.rbegin(), links_.rend(),
                                   [&](const PlaneLink &link) { return link.from == from && link.to == to; });

    return last != links_.rend() && median(misses(*last, warps_)) < max_spread_to_go_on;
}

void StackMatcher::solve(MotionModel model)
{
    warps_ = solve_warps(model, warps_, middle_, links_, size_);
}

void StackMatcher::match_smallest()
{
    const Level level = level_of(sides.front());

    for (const MatchablePlane &plane : level.planes)
        blank_.push_back(plane.corners().size() < min_matches);
    match_neighbours(level);
    if (links_.empty())
        return;
    links_of_trust_ = links_;
    spread_from_middle();
    solve(MotionModel::Similarity);
    for (std::size_t distance = 2; distance <= first_distance; distance *= 2)
        match_along(level, distance);
    solve(MotionModel::Similarity);
}

void StackMatcher::match_larger()
{
    double last_pixel = static_cast<double>(std::max(size_.width, size_.height)) / sides.front();

    for (std::size_t i = 1; i < sides.size() && !links_.empty(); i++) {
        if (last_pixel < 2.0)
            break;
        const Level level = level_of(sides[i]);
        const std::size_t links_before = links_.size();
        for (std::size_t distance = 1; distance <= later_distance; distance *= 2)
            match_along(level, distance);
        solve(MotionModel::Similarity);
        if (links_.size() == links_before)
            break;
        last_pixel = level.pixel;
    }
}

void StackMatcher::choose_model(std::optional<MotionModel> model)
{
    if (links_.empty() || model == MotionModel::Similarity)
        return;
    const std::vector<PlaneWarp> similarities = warps_;
    const double miss = typical_miss(links_, warps_);
    if (!model && miss < miss_to_explain)
        return;
    solve(MotionModel::Homography);
    if (!model && typical_miss(links_, warps_) > share_left * miss)
        warps_ = similarities;
}

std::vector<PlaneAlignment> StackMatcher::alignments() const
{
    const std::vector<bool> trusted = trusted_planes(warps_.size(), middle_, links_of_trust_, warps_);
    std::vector<PlaneAlignment> result;

    for (std::size_t z = 0; z < warps_.size(); z++)
        result.push_back({warps_[z].inverse(), trusted[z], !trusted[z] && blank_[z]});
    return result;
}

} // namespace

std::vector<PlaneAlignment> align_stack(std::span<const cv::Mat> planes, std::optional<MotionModel> model)
{
    StackMatcher matcher(planes);

    matcher.match_smallest();
    matcher.match_larger();
    matcher.choose_model(model);
    return matcher.alignments();
}

} // namespace dff
