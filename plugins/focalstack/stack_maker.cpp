/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/stack_maker.h"

#include "focalstack/rolling_stacks.h"
#include "focalstack/sweep_stacks.h"

#include <cmath>
#include <utility>

namespace dff {

std::unique_ptr<StackMaker> StackMaker::create(StackWindow window, const GstFocalStackInfo &info,
                                               OnMissing on_missing, unsigned allowance,
                                               MuxStatistics &statistics)
{
    if (window == StackWindow::Rolling)
        return std::make_unique<RollingStacks>(info, on_missing, statistics);
    return std::make_unique<SweepStacks>(info, on_missing, allowance, statistics);
}

StackMaker::StackMaker(const GstFocalStackInfo &info, OnMissing on_missing, MuxStatistics &statistics)
    : pool_(info), on_missing_(on_missing), statistics_(statistics)
{
    powers_.fill(NAN);
}

std::optional<Outcome> StackMaker::next_outcome()
{
    if (outcomes_.empty())
        return std::nullopt;
    Outcome next = std::move(outcomes_.front());
    outcomes_.pop_front();
    return next;
}

void StackMaker::put(PartialStack &stack, const PlaneFrame &frame)
{
    stack.put(frame.focus.plane, frame);
    powers_[frame.focus.plane] = frame.focus.power;
}

void StackMaker::refuse(const PlaneFrame &frame, FrameVerdict verdict)
{
    if (verdict == FrameVerdict::Repeated)
        statistics_.repeated++;
    else
        statistics_.late++;
    outcomes_.push_back({nullptr, frame.time});
}

void StackMaker::drop_stack(TimeSpan time)
{
    statistics_.dropped++;
    outcomes_.push_back({nullptr, time});
}

void StackMaker::send(PartialStack &stack, uint64_t filled)
{
    outcomes_.push_back({stack.finish(statistics_.stacks, filled), {}});
    statistics_.stacks++;
}

void StackMaker::fill_from_neighbours(PartialStack &stack, uint64_t fresh) const
{
    for (unsigned z = 0; z < planes(); z++) {
        if (fresh & plane_bit(z))
            continue;
        unsigned distance = 1;
        const auto is_fresh = [&](unsigned plane) { return plane < planes() && (fresh & plane_bit(plane)); };
        while (!is_fresh(z - distance) && !is_fresh(z + distance))
            distance++;
        stack.repeat(is_fresh(z - distance) ? z - distance : z + distance, z, powers_[z]);
    }
}

} // namespace dff
