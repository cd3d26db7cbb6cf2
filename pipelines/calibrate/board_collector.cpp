/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "board_collector.h"

#include "coverage.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

namespace dff {

namespace {

constexpr double rest_px = 0.5;       /* that a board at rest seems to move, by noise */
constexpr double another_pose = 0.02; /* of the picture's width */
constexpr std::size_t enough_sweeps = 8;

std::string what_is_seen(const BoardView &view, std::size_t number)
{
    double least = 1e9, most = -1e9;
    for (const double plane : view.focus)
        if (!std::isnan(plane)) {
            least = std::min(least, plane);
            most = std::max(most, plane);
        }
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << "board " << number << ": sharp in planes " << least
         << " to " << most << ", its middle at " << std::setprecision(0) << view.middle().x << ", "
         << view.middle().y << " px";
    return text.str();
}

} // namespace

void BoardCollector::add(const Sweep &sweep)
{
    try {
        BoardView view = measure_board(board_, {sweep});
        if (pose_ && view.moved_from(*pose_) > rest_px)
            keep();
        if (!pose_ && is_known(view))
            return tell_once("the board is where it was: move it");
        resting_.push_back(sweep);
        if (!pose_)
            pose_ = std::move(view);
        last_told_.clear();
        if (resting_.size() == enough_sweeps)
            keep();
    } catch (const NoBoard &fault) {
        keep();
        tell_once(fault.what());
    }
}

bool BoardCollector::is_known(const BoardView &view) const
{
    return std::any_of(views_.begin(), views_.end(), [&](const BoardView &other) {
        return view.moved_from(other) < another_pose * view.picture.width;
    });
}

void BoardCollector::tell_once(const std::string &line)
{
    if (last_told_ != line)
        tell_(line);
    last_told_ = line;
}

void BoardCollector::end_source()
{
    keep();
    last_told_.clear();
}

void BoardCollector::keep()
{
    if (!pose_)
        return;
    const std::vector<Sweep> sweeps = std::exchange(resting_, {});
    const BoardView first = *std::exchange(pose_, std::nullopt);
    try {
        BoardView view = sweeps.size() > 1 ? measure_board(board_, sweeps) : first;
        views_.push_back(std::move(view));
        pixels_.add(sweeps.front());
        tell_(what_is_seen(views_.back(), views_.size()));
        if (const std::string missing = still_missing(views_); !missing.empty())
            tell_(missing);
    } catch (const NoBoard &fault) {
        tell_(fault.what());
    }
}

} // namespace dff
