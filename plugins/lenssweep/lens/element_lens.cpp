/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "element_lens.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace dff {

namespace {

/* Frames until the property must read what was set: more than libcamera takes, which goes 35 dioptres by 1.5
 * a frame after some that are on their way. */
constexpr unsigned longest_way = 45;

/* Throws std::invalid_argument unless every position is one that the property takes, and another than the one
 * before. */
void check(LensProperty &property, const std::vector<double> &positions)
{
    const auto [lowest, highest] = property.range();
    for (const double position : positions) {
        if (!(position >= lowest && position <= highest)) {
            std::ostringstream text;
            text << property.name() << " is " << lowest << " to " << highest << ", not " << position
                 << ": set near and far, or give lens-profile if it is not in dioptres";
            throw std::invalid_argument(text.str());
        }
    }
    if (std::adjacent_find(positions.begin(), positions.end()) != positions.end())
        throw std::invalid_argument("two planes fall on one value of " + property.name() +
                                    ": ask for fewer planes");
}

double least_step(const std::vector<double> &positions)
{
    double least = HUGE_VAL;
    for (size_t k = 1; k < positions.size(); k++)
        least = std::min(least, std::abs(positions[k] - positions[k - 1]));
    return least;
}

} // namespace

ElementLens::ElementLens(std::unique_ptr<LensProperty> property, std::optional<FocusPoints> points)
    : property_(std::move(property)), points_(std::move(points))
{
}

ElementLens::~ElementLens()
{
    try {
        stop();
    } catch (const LensError &) {
        /* The element is gone, and its autofocus with it. */
    }
}

void ElementLens::prepare(const LensSweep &sweep)
{
    std::vector<double> positions;
    for (unsigned plane = 0; plane < sweep.plan.planes(); ++plane) {
        const double power = sweep.plan.power(plane);
        const double position = points_ ? points_->position(power) : power;
        positions.push_back(property_->is_integer() ? std::round(position) : position);
    }
    check(*property_, positions);
    positions_ = std::move(positions);
    tolerance_ = least_step(positions_) / 4;
}

void ElementLens::start()
{
    property_->take_over();
    started_ = true;
}

void ElementLens::stop()
{
    if (started_)
        property_->give_back();
    started_ = false;
}

int ElementLens::code(unsigned plane) const
{
    return property_->is_integer() ? static_cast<int>(positions_.at(plane)) : -1;
}

void ElementLens::move_to(unsigned plane)
{
    target_ = positions_.at(plane);
    asked_ = 0;
    property_->set(target_);
}

std::optional<bool> ElementLens::at_plane()
{
    const double now = property_->get();
    if (std::abs(now - target_) <= tolerance_)
        return true;
    if (++asked_ >= longest_way) {
        std::ostringstream text;
        text << property_->name() << " reads " << now << " long after " << target_
             << " was set: the camera's lens may not reach so far (set near and far), or it has none";
        throw LensError(text.str());
    }
    return false;
}

} // namespace dff
