/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/rolling_stacks.h"

#include <utility>

namespace dff {

RollingStacks::RollingStacks(const GstFocalStackInfo &info, OnMissing on_missing, MuxStatistics &statistics)
    : StackMaker(info, on_missing, statistics), rolling_(info.planes)
{
}

bool RollingStacks::add(const PlaneFrame &frame)
{
    const uint64_t reordered = rolling_.reordered();
    const uint64_t lost = rolling_.lost();
    const FrameVerdict verdict = rolling_.add(frame.focus.sweep, frame.focus.plane);
    statistics_.reordered += rolling_.reordered() - reordered;
    statistics_.lost += rolling_.lost() - lost;
    if (verdict != FrameVerdict::Taken) {
        refuse(frame, verdict);
        return true;
    }

    if (!window_) {
        BufferPtr buffer = pool_.acquire();
        if (!buffer)
            return false;
        window_.emplace(info(), std::move(buffer));
    }
    if (!put(*window_, frame))
        return false;
    return !rolling_.full() || send_window();
}

bool RollingStacks::send_window()
{
    const uint64_t stale = rolling_.stale();
    const uint64_t fresh = all_planes(planes()) & ~stale;
    if (stale != 0 && on_missing_ == OnMissing::Drop) {
        drop_stack(window_->span(fresh), stale);
        return true;
    }

    BufferPtr buffer = pool_.acquire();
    if (!buffer)
        return false;
    PartialStack stack(info(), std::move(buffer));
    stack.take_over(*window_);
    if (on_missing_ == OnMissing::Repeat)
        fill_from_neighbours(stack, fresh);
    send(stack, stale);
    return true;
}

/* Nothing is ever left over, but a window that did not fill. */
void RollingStacks::finish()
{
    if (window_ && !rolling_.full())
        drop_stack(window_->span(all_planes(planes())), all_planes(planes()) & ~rolling_.held());
}

} // namespace dff
