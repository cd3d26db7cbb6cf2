/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/stack_assembler.h"

#include <stdexcept>

namespace dff {

StackAssembler::StackAssembler(unsigned planes, unsigned allowance) : planes_(planes), allowance_(allowance)
{
    if (planes < 2 || planes > longest_stack)
        throw std::invalid_argument("a stack has 2 to 64 planes");
}

FrameVerdict StackAssembler::add(uint64_t sweep, unsigned plane)
{
    if (!next_sweep_)
        begin(sweep);
    if (sweep < *next_sweep_)
        return add_late(sweep, plane);
    late_in_a_row_ = 0;

    if (sweep - *next_sweep_ > longest_gap + open_.size()) {
        finish();
        begin(sweep);
    }
    open_up_to(sweep);
    OpenSweep &open = open_[sweep - *next_sweep_];
    if (open.present & plane_bit(plane))
        return FrameVerdict::Repeated;
    put(open, plane);
    close_what_is_over();
    return FrameVerdict::Taken;
}

FrameVerdict StackAssembler::add_late(uint64_t sweep, unsigned plane)
{
    if (++late_in_a_row_ < longest_delay(planes_))
        return FrameVerdict::Late;
    finish();
    begin(sweep);
    return add(sweep, plane);
}

void StackAssembler::begin(uint64_t sweep)
{
    next_sweep_ = sweep;
    late_in_a_row_ = 0;
}

void StackAssembler::open_up_to(uint64_t sweep)
{
    while (open_.size() <= sweep - *next_sweep_)
        open_.push_back({*next_sweep_ + open_.size(), 0, 0, {planes_, 0}, 0});
}

void StackAssembler::put(OpenSweep &open, unsigned plane)
{
    if (open.present == 0) {
        open.direction = SweepDirection(planes_, plane);
        open.last_plane = plane;
    }
    const bool backwards = open.direction.before(plane, open.last_plane);
    if (open.overtaken > 0 || backwards)
        reordered_++;
    if (!backwards)
        open.last_plane = plane;
    open.present |= plane_bit(plane);

    for (OpenSweep &earlier : open_) {
        if (earlier.sweep >= open.sweep)
            break;
        earlier.overtaken++;
    }
}

void StackAssembler::close_front()
{
    finished_.push_back({open_.front().sweep, open_.front().present});
    open_.pop_front();
    ++*next_sweep_;
}

void StackAssembler::close_what_is_over()
{
    size_t over = 0;
    for (size_t i = 0; i < open_.size(); i++)
        if (open_[i].present == all_planes(planes_) || open_[i].overtaken > allowance_)
            over = i + 1;
    while (over-- > 0)
        close_front();
}

void StackAssembler::finish()
{
    while (!open_.empty())
        close_front();
}

std::optional<FinishedSweep> StackAssembler::next_finished()
{
    if (finished_.empty())
        return std::nullopt;
    const FinishedSweep next = finished_.front();
    finished_.pop_front();
    return next;
}

} // namespace dff
