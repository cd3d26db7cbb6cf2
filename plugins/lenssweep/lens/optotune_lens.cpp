/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optotune_lens.h"

#include "interruptible_sleep.h"
#include "uncalibrated_positions.h"

#include <sstream>
#include <stdexcept>

namespace dff {

namespace {

/* By the data sheets of EL-10-30 and EL-16-40 a step has settled after 15 and 25 ms. */
constexpr std::chrono::milliseconds settle_time{25};

bool is_by_current(const std::optional<FocusPoints> &points)
{
    if (!points || points->unit().empty() || points->unit() == "dioptre")
        return false;
    if (points->unit() != "mA")
        throw std::invalid_argument("the lens profile of an Optotune lens has the unit \"" + points->unit() +
                                    "\", and must have \"dioptre\" or \"mA\"");
    return true;
}

} // namespace

OptotuneLens::OptotuneLens(const std::string &device, std::optional<FocusPoints> points)
    : driver_(device), points_(std::move(points)), by_current_(is_by_current(points_))
{
}

OptotuneLens::~OptotuneLens()
{
    try {
        stop();
    } catch (const LensError &) {
        /* Nothing more can be done: the driver is unplugged, or does not hear. */
    }
}

OptotuneDriver::Range OptotuneLens::enter_mode()
{
    if (!by_current_)
        return driver_.enter_focal_power_mode();
    driver_.enter_current_mode();
    return {-driver_.greatest_current(), driver_.greatest_current()};
}

void OptotuneLens::prepare(const LensSweep &sweep)
{
    const auto range = enter_mode();
    std::vector<double> positions;
    for (unsigned plane = 0; plane < sweep.plan.planes(); ++plane) {
        const double power = sweep.plan.power(plane);
        positions.push_back(points_ ? points_->position(power) : power);
        if (!(positions.back() >= range.least && positions.back() <= range.greatest)) {
            std::ostringstream text;
            text << "the Optotune lens reaches " << range.least << " to " << range.greatest
                 << (by_current_ ? " mA" : " dioptres at its temperature limits") << ", not "
                 << positions.back()
                 << ": set near and far, or a lens-profile that says where the camera sees infinity";
            throw std::invalid_argument(text.str());
        }
    }
    require_different(positions);
    positions_ = std::move(positions);
}

void OptotuneLens::stop()
{
    driver_.rest();
}

int OptotuneLens::code(unsigned plane) const
{
    const double position = positions_.at(plane);
    return by_current_ ? driver_.current_code(position) : driver_.focal_power_code(position);
}

void OptotuneLens::move_to(unsigned plane)
{
    if (plane == 0)
        driver_.check_temperature();
    if (by_current_)
        driver_.set_current(positions_.at(plane));
    else
        driver_.set_focal_power(positions_.at(plane));
    settled_at_ = std::chrono::steady_clock::now() + settle_time;
}

bool OptotuneLens::wait_settled(const std::stop_token &stop)
{
    return sleep_until(settled_at_, stop);
}

} // namespace dff
