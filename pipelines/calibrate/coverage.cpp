/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "coverage.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dff {

namespace {

constexpr std::array<const char *, parts_of_picture> part_names{
    "upper left", "top", "upper right", "left", "middle", "right", "lower left", "bottom", "lower right"};

std::string joined(const std::vector<std::string> &words)
{
    std::string text;
    for (const std::string &word : words)
        text += (text.empty() ? "" : ", ") + word;
    return text;
}

std::vector<std::string> planes_missing(const std::vector<BoardView> &views)
{
    std::vector<std::string> missing;
    for (std::size_t z = 0; z < views.front().planes.size(); z++) {
        const bool seen = std::any_of(views.begin(), views.end(), [z](const BoardView &view) {
            return std::any_of(view.focus.begin(), view.focus.end(),
                               [z](double focus) { return is_sharp_in(focus, z); });
        });
        if (!seen)
            missing.push_back(std::to_string(z));
    }
    return missing;
}

std::vector<std::string> parts_missing(const std::vector<BoardView> &views)
{
    std::set<int> seen;
    for (const BoardView &view : views)
        seen.merge(parts_with(view.corners, view.picture));
    std::vector<std::string> missing;
    for (int part = 0; part < parts_of_picture; part++)
        if (!seen.contains(part))
            missing.emplace_back(part_names[static_cast<std::size_t>(part)]);
    return missing;
}

} // namespace

std::set<int> parts_with(const std::vector<cv::Point2d> &corners, const cv::Size &picture)
{
    std::set<int> parts;
    for (const cv::Point2d &corner : corners) {
        const int column = static_cast<int>(3 * corner.x / picture.width);
        const int row = static_cast<int>(3 * corner.y / picture.height);
        parts.insert(3 * std::clamp(row, 0, 2) + std::clamp(column, 0, 2));
    }
    return parts;
}

bool is_sharp_in(double focus, std::size_t plane)
{
    constexpr double nearly = 0.35; /* planes */
    return std::abs(focus - static_cast<double>(plane)) < nearly;
}

std::string still_missing(const std::vector<BoardView> &views)
{
    const std::vector<std::string> planes = planes_missing(views), parts = parts_missing(views);
    std::vector<std::string> missing;
    if (!planes.empty())
        missing.push_back("sharp in plane " + joined(planes));
    if (!parts.empty())
        missing.push_back("in the picture's " + joined(parts));
    return missing.empty()
               ? ""
               : "still to be shown: " + missing.front() + (missing.size() > 1 ? "; " + missing.back() : "");
}

} // namespace dff
