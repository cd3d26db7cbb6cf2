/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/sweep_gate.h"

#include <algorithm>

namespace dff {

void SweepGate::open(unsigned plane)
{
    const std::lock_guard lock(mutex_);
    inputs_.at(plane) = {true, false, std::nullopt, inputs_.at(plane).opened + 1};
    moved_.notify_all();
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

GatePass SweepGate::enter(unsigned plane, std::optional<uint64_t> lead)
{
    std::unique_lock lock(mutex_);
    const Input &own = inputs_.at(plane);
    const auto may_enter = [&] {
        return holds_ == 0 && !occupied_ && (!lead || all_are_near(own.sweep.value_or(0), *lead));
    };
    const unsigned opened = own.opened;
    const auto closed = [&] { return !own.open || own.opened != opened; };
    moved_.wait(lock, [&] { return shut_ || own.shut || closed() || may_enter(); });
    if (shut_)
        return GatePass::Shut;
    if (closed())
        return GatePass::Closed;
    if (own.shut)
        return GatePass::Shut;
    occupied_ = true;
    return GatePass::Through;
}

void SweepGate::leave()
{
    const std::lock_guard lock(mutex_);
    occupied_ = false;
    moved_.notify_all();
}

bool SweepGate::all_are_near(uint64_t sweep, uint64_t lead) const
{
    return std::all_of(inputs_.begin(), inputs_.end(), [&](const Input &input) {
        return !input.open || (input.sweep && (*input.sweep >= sweep || sweep - *input.sweep <= lead));
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
    holds_ = 0;
}

void SweepGate::hold()
{
    const std::lock_guard lock(mutex_);
    holds_++;
}

void SweepGate::release()
{
    const std::lock_guard lock(mutex_);
    if (holds_ > 0) /* a stop and a start may have come between */
        holds_--;
    moved_.notify_all();
}

} // namespace dff
