/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/sweep_gate.h"

#include <algorithm>

namespace dff {

void SweepGate::open(unsigned plane)
{
    const std::lock_guard lock(mutex_);
    inputs_.at(plane) = {true, false, std::nullopt};
}

void SweepGate::close(unsigned plane)
{
    const std::lock_guard lock(mutex_);
    inputs_.at(plane).open = false;
    moved_.notify_all();
}

void SweepGate::close_all()
{
    const std::lock_guard lock(mutex_);
    inputs_.fill({});
    moved_.notify_all();
}

void SweepGate::arrive(unsigned plane, uint64_t sweep)
{
    const std::lock_guard lock(mutex_);
    inputs_.at(plane).sweep = sweep;
    moved_.notify_all();
}

bool SweepGate::wait(unsigned plane)
{
    std::unique_lock lock(mutex_);
    const Input &own = inputs_.at(plane);
    moved_.wait(lock, [&] {
        return shut_ || own.shut || !own.open || (!held_ && all_are_near(own.sweep.value_or(0)));
    });
    return !shut_ && !own.shut && own.open;
}

bool SweepGate::all_are_near(uint64_t sweep) const
{
    return std::all_of(inputs_.begin(), inputs_.end(), [sweep](const Input &input) {
        return !input.open || (input.sweep && (*input.sweep >= sweep || sweep - *input.sweep <= 1));
    });
}

void SweepGate::shut()
{
    const std::lock_guard lock(mutex_);
    shut_ = true;
    moved_.notify_all();
}

void SweepGate::shut(unsigned plane)
{
    const std::lock_guard lock(mutex_);
    inputs_.at(plane).shut = true;
    moved_.notify_all();
}

void SweepGate::let_in()
{
    const std::lock_guard lock(mutex_);
    shut_ = false;
}

void SweepGate::hold()
{
    const std::lock_guard lock(mutex_);
    held_ = true;
}

void SweepGate::release()
{
    const std::lock_guard lock(mutex_);
    held_ = false;
    moved_.notify_all();
}

} // namespace dff
