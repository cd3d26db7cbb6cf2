/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "frame_cycle.h"

FrameCycle::FrameCycle(unsigned planes, std::optional<uint64_t> period_ns)
    : planes_(planes), period_ns_(period_ns)
{
}

void FrameCycle::restart()
{
    if (count_)
        restart_at_ = (*count_ / planes_ + 1) * planes_;
    count_.reset();
}

/* How many planes lie between the last frame and this one; a repeated frame has none. Empty if unknown. */
std::optional<uint64_t> FrameCycle::steps_to(const FrameTrace &frame) const
{
    if (frame.number && last_.number) {
        if (*frame.number < *last_.number)
            return std::nullopt;
        return *frame.number - *last_.number;
    }
    if (!frame.discontinuous)
        return 1;
    if (!frame.time_ns || !last_.time_ns || !period_ns_ || *frame.time_ns <= *last_.time_ns)
        return std::nullopt;
    return (*frame.time_ns - *last_.time_ns + *period_ns_ / 2) / *period_ns_;
}

PlaneLabel FrameCycle::label(const FrameTrace &frame)
{
    lost_place_ = false;
    if (count_) {
        const auto steps = steps_to(frame);
        lost_place_ = !steps;
        if (steps)
            *count_ += *steps;
        else
            restart();
    }
    if (!count_)
        count_ = restart_at_;
    last_ = frame;
    return {*count_ / planes_, static_cast<unsigned>(*count_ % planes_)};
}
