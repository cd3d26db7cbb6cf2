/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/sweep_stacks.h"

#include <bit>
#include <utility>

namespace dff {

SweepStacks::SweepStacks(const GstFocalStackInfo &info, OnMissing on_missing, unsigned allowance,
                         MuxStatistics &statistics)
    : StackMaker(info, on_missing, statistics), assembler_(info.planes, allowance)
{
}

bool SweepStacks::add(const PlaneFrame &frame)
{
    const uint64_t reordered = assembler_.reordered();
    const FrameVerdict verdict = assembler_.add(frame.focus.sweep, frame.focus.plane);
    statistics_.reordered += assembler_.reordered() - reordered;
    if (verdict != FrameVerdict::Taken) {
        refuse(frame, verdict);
        return true;
    }

    auto open = open_.find(frame.focus.sweep);
    if (open == open_.end()) {
        BufferPtr buffer = pool_.acquire();
        if (!buffer)
            return false;
        open = open_.emplace(frame.focus.sweep, PartialStack(info(), std::move(buffer))).first;
    }
    if (!put(open->second, frame))
        return false;
    settle();
    return true;
}

void SweepStacks::finish()
{
    assembler_.finish();
    settle();
}

void SweepStacks::settle()
{
    while (const auto finished = assembler_.next_finished()) {
        statistics_.lost += planes() - static_cast<unsigned>(std::popcount(finished->present));
        auto open = open_.extract(finished->sweep);
        if (open)
            finish_stack(open.mapped(), finished->present);
        else
            drop_stack({}, all_planes(planes()));
    }
}

void SweepStacks::finish_stack(PartialStack &stack, uint64_t present)
{
    const uint64_t missing = all_planes(planes()) & ~present;
    if (missing != 0 && !fill(stack, present)) {
        drop_stack(stack.span(present), missing);
        return;
    }
    send(stack, missing);
    if (on_missing_ == OnMissing::Hold)
        last_.emplace(std::move(stack));
}

bool SweepStacks::fill(PartialStack &stack, uint64_t present) const
{
    if (on_missing_ == OnMissing::Repeat)
        fill_from_neighbours(stack, present);
    else if (on_missing_ == OnMissing::Hold && last_)
        for (unsigned z = 0; z < planes(); z++) {
            if (!(present & plane_bit(z)))
                stack.take_over(*last_, z);
        }
    else
        return false;
    return true;
}

} // namespace dff
