/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fpga_sweep_lens.h"

#include <algorithm>

namespace dff {

std::vector<PlaneStep> plane_steps(const SweepPlan &plan, const LensProfile &profile)
{
    std::vector<PlaneStep> steps;
    const LensDriver &driver = driver_of(profile);
    double before = profile.drive(plan.far()); /* plane 0 comes after the last one */
    for (unsigned plane = 0; plane < plan.planes(); ++plane) {
        const double hold = profile.drive(plan.power(plane));
        const double beyond = hold + profile.overdrive() * (hold - before);
        steps.push_back({std::clamp(beyond, driver.lowest, driver.highest), profile.overdrive_delay(), hold,
                         profile.settle()});
        before = hold;
    }
    return steps;
}

FpgaSweepLens::FpgaSweepLens(std::unique_ptr<I2cBus> bus, LensProfile profile)
    : bus_(std::move(bus)), profile_(std::move(profile)), sequencer_(*bus_)
{
}

void FpgaSweepLens::prepare(const LensSweep &sweep)
{
    SweepTable table;
    table.driver = &driver_of(profile_);
    table.planes = plane_steps(sweep.plan, profile_);
    table.period = sweep.period;
    const auto needed = sequencer_.timing().gap + profile_.overdrive_delay();
    table.exposure = sweep.exposure.count() > 0
                         ? sweep.exposure
                         : std::max(sweep.period - needed - profile_.settle(), sweep.period / 2);
    /* Settling beyond what the gap holds goes on into the exposure; the label is the calibrated vergence. */
    const auto room = std::max(sweep.period - table.exposure - needed, std::chrono::microseconds{0});
    for (auto &step : table.planes) {
        step.settle = std::min(step.settle, room);
    }
    sequencer_.load(table);
    steps_ = std::move(table.planes);
    gated_ = sweep.gated;
}

void FpgaSweepLens::start()
{
    sequencer_.start(gated_);
}

void FpgaSweepLens::stop()
{
    sequencer_.stop();
}

int FpgaSweepLens::code(unsigned plane) const
{
    return driver_of(profile_).code(steps_.at(plane).hold);
}

void FpgaSweepLens::check()
{
    const auto status = sequencer_.status();
    if (status.errors != 0) {
        throw LensError("the sweep sequencer stopped at plane " + std::to_string(status.plane) + ": " +
                        describe_errors(status.errors));
    }
}

std::uint32_t FpgaSweepLens::sweep_count()
{
    return sequencer_.sweep_count();
}

std::uint32_t FpgaSweepLens::frame_count()
{
    return sequencer_.frame_count();
}

} // namespace dff
