/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/link_trust.h"

#include <array>

namespace dff {
namespace {

/* Pixels that were matched. */
constexpr double max_miss = 1.0;

constexpr double min_share = 0.8;
constexpr double min_share_of_quarter = 0.5;

/* A quarter with fewer points than this has no say. */
constexpr std::size_t min_points_of_quarter = 6;

std::size_t quarter_of(cv::Point2d point)
{
    return (point.x > 0.0 ? 1 : 0) + (point.y > 0.0 ? 2 : 0);
}

bool is_believed(const PlaneLink &link, std::span<const PlaneWarp> warps)
{
    const std::vector<double> miss = misses(link, warps);
    std::array<std::size_t, 4> all{}, good{};

    for (std::size_t i = 0; i < miss.size(); i++) {
        const std::size_t quarter = quarter_of(link.match.from[i]);
        all[quarter]++;
        good[quarter] += miss[i] < max_miss ? 1 : 0;
    }
    for (std::size_t i = 0; i < all.size(); i++) {
        if (all[i] >= min_points_of_quarter && good[i] < min_share_of_quarter * all[i])
            return false;
    }
    return good[0] + good[1] + good[2] + good[3] >= min_share * miss.size();
}

} // namespace

std::vector<bool> trusted_planes(std::size_t planes, std::size_t middle, std::span<const PlaneLink> links,
                                 std::span<const PlaneWarp> warps)
{
    std::vector<bool> reached(planes, false);
    bool grown = true;

    reached[middle] = true;
    while (grown) {
        grown = false;
        for (const PlaneLink &link : links) {
            if (reached[link.from] != reached[link.to] && is_believed(link, warps))
                reached[link.from] = reached[link.to] = grown = true;
        }
    }
    return reached;
}

double typical_miss(std::span<const PlaneLink> links, std::span<const PlaneWarp> warps)
{
    double sum = 0.0;

    for (const PlaneLink &link : links)
        sum += median(misses(link, warps));
    return sum / static_cast<double>(links.size());
}

} // namespace dff
