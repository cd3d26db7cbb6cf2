/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/stack_maker.h"

#include "focalstack/rolling_stacks.h"
#include "focalstack/sweep_stacks.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

bool StackMaker::put(PartialStack &stack, const PlaneFrame &frame)
{
    if (!stack.put(frame.focus.plane, frame))
        return false;
    powers_[frame.focus.plane] = frame.focus.power;
    return true;
}

void StackMaker::refuse(const PlaneFrame &frame, FrameVerdict verdict)
{
    if (verdict == FrameVerdict::Repeated)
        statistics_.repeated++;
    else
        statistics_.late++;
    outcomes_.push_back({nullptr, frame.time});
}

void StackMaker::drop_stack(TimeSpan time, uint64_t missing)
{
    statistics_.dropped++;
    statistics_.never_there &= missing;
    outcomes_.push_back({nullptr, time});
}

void StackMaker::send(PartialStack &stack, uint64_t filled)
{
    outcomes_.push_back({stack.finish(statistics_.stacks, filled), {}});
    statistics_.stacks++;
    statistics_.never_there = ~uint64_t{0};
}

/* Dioptres from plane to plane are even, as far as nothing else is known: only a plane that never came yet is
 * reckoned, along the line through the two nearest planes whose power is known. With a power less than the
 * others the stack's depth would have another unit. */
double StackMaker::power_of(const PartialStack &stack, unsigned plane, uint64_t fresh) const
{
    if (!std::isnan(powers_[plane]))
        return powers_[plane];
    std::vector<unsigned> known;
    for (unsigned z = 0; z < planes(); z++)
        if ((fresh & plane_bit(z)) && !std::isnan(stack.focus(z).power))
            known.push_back(z);
    if (known.size() < 2)
        return NAN;
    const auto distance = [plane](unsigned z) { return z < plane ? plane - z : z - plane; };
    std::partial_sort(known.begin(), known.begin() + 2, known.end(),
                      [&](unsigned a, unsigned b) { return distance(a) < distance(b); });
    const double from = stack.focus(known[0]).power;
    const double step = (stack.focus(known[1]).power - from) /
                        (static_cast<double>(known[1]) - static_cast<double>(known[0]));
    return from + step * (static_cast<double>(plane) - static_cast<double>(known[0]));
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
        stack.repeat(is_fresh(z - distance) ? z - distance : z + distance, z, power_of(stack, z, fresh));
    }
}

} // namespace dff
