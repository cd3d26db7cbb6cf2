/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "board_collector.h"

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
        if (resting_.size() < enough_sweeps)
            resting_.push_back(sweep);
        if (!pose_)
            pose_ = std::move(view);
        last_fault_.clear();
    } catch (const NoBoard &fault) {
        keep();
        if (last_fault_ != fault.what())
            tell_(fault.what());
        last_fault_ = fault.what();
    }
}

void BoardCollector::end_source()
{
    keep();
    last_fault_.clear();
}

void BoardCollector::keep()
{
    if (!pose_)
        return;
    const std::vector<Sweep> sweeps = std::exchange(resting_, {});
    const BoardView first = *std::exchange(pose_, std::nullopt);
    try {
        BoardView view = sweeps.size() > 1 ? measure_board(board_, sweeps) : first;
        const bool known = std::any_of(views_.begin(), views_.end(), [&](const BoardView &other) {
            return view.moved_from(other) < another_pose * view.picture.width;
        });
        if (known)
            return tell_("the board is where it was: move it");
        views_.push_back(std::move(view));
        pixels_.add(sweeps.front());
        tell_(what_is_seen(views_.back(), views_.size()));
    } catch (const NoBoard &fault) {
        tell_(fault.what());
    }
}

} // namespace dff
