/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/stack_aligner.h"

#include <opencv2/imgproc.hpp>

#include "focalstack/plane_matcher.h"
#include "focalstack/warp_solver.h"

namespace dff {
namespace {

/* Pixels; twice of it costs four times the time and finds nothing new. */
constexpr int max_side = 1280;

/* Links over more planes than one keep errors from adding up; beyond eight there is little left in common. */
constexpr std::size_t max_distance = 8;

/* Pixels. Less is not worth a resampling. */
constexpr double negligible_shift = 0.02;

std::vector<PlaneLink> link_planes(std::span<const MatchablePlane> planes)
{
    std::vector<PlaneLink> links;

    for (std::size_t distance = 1; distance <= max_distance; distance *= 2) {
        for (std::size_t z = 0; z + distance < planes.size(); z++) {
            PlaneMatch match = match_planes(planes[z], planes[z + distance]);
            if (match.trusted())
                links.push_back({z, z + distance, std::move(match)});
        }
    }
    return links;
}

/* Which planes can be reached over links from the middle. */
std::vector<bool> find_linked(std::size_t planes, std::span<const PlaneLink> links)
{
    std::vector<bool> linked(planes, false);
    bool grown = true;

    linked[middle_plane(planes)] = true;
    while (grown) {
        grown = false;
        for (const PlaneLink &link : links) {
            if (linked[link.from] != linked[link.to])
                linked[link.from] = linked[link.to] = grown = true;
        }
    }
    return linked;
}

} // namespace

std::vector<PlaneAlignment> align_stack(std::span<const cv::Mat> planes)
{
    std::vector<MatchablePlane> matchable;
    for (const cv::Mat &plane : planes)
        matchable.emplace_back(plane, max_side);

    const cv::Size reduced = matchable.front().size();
    const std::vector<PlaneLink> links = link_planes(matchable);
    const std::vector<bool> linked = find_linked(planes.size(), links);
    const std::vector<PlaneWarp> onto_middle =
        solve_warps(planes.size(), middle_plane(planes.size()), links, reduced);

    std::vector<PlaneAlignment> alignments;
    for (std::size_t z = 0; z < planes.size(); z++) {
        PlaneWarp warp = onto_middle[z].inverse();
        warp.dx *= static_cast<double>(planes[z].cols) / reduced.width;
        warp.dy *= static_cast<double>(planes[z].rows) / reduced.height;
        alignments.push_back({warp, linked[z]});
    }
    return alignments;
}

void undo_warp(const cv::Mat &component, cv::Mat aligned, const PlaneWarp &warp, int step)
{
    if (warp.largest_shift(component.size() * step) < negligible_shift)
        component.copyTo(aligned);
    else
        cv::warpAffine(component, aligned, warp.matrix(component.size(), step), component.size(),
                       cv::INTER_LANCZOS4 | cv::WARP_INVERSE_MAP, cv::BORDER_REFLECT_101);
}

} // namespace dff
