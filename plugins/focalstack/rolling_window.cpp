/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/rolling_window.h"

#include <stdexcept>

namespace dff {

RollingWindow::RollingWindow(unsigned planes) : planes_(planes)
{
    if (planes < 2 || planes > longest_stack)
        throw std::invalid_argument("a stack has 2 to 64 planes");
}

/* Whether the newest frame came a whole sweep or more after this one. */
bool RollingWindow::passed(uint64_t sweep, unsigned plane) const
{
    if (sweep >= newest_->sweep)
        return false;
    return sweep + 1 < newest_->sweep || plane == newest_->plane ||
           newest_->direction.before(plane, newest_->plane);
}

FrameVerdict RollingWindow::add(uint64_t sweep, unsigned plane)
{
    if (!newest_ || (sweep > newest_->sweep && sweep - newest_->sweep > longest_gap))
        restart(sweep, plane);

    if ((held_ & plane_bit(plane)) && sweep == sweep_[plane])
        return FrameVerdict::Repeated;
    if (passed(sweep, plane)) {
        if (++late_in_a_row_ < longest_delay(planes_))
            return FrameVerdict::Late;
        restart(sweep, plane);
    }
    put(sweep, plane);
    return FrameVerdict::Taken;
}

void RollingWindow::restart(uint64_t sweep, unsigned plane)
{
    newest_ = Newest{sweep, plane, {planes_, plane}};
    held_ = 0;
}

void RollingWindow::put(uint64_t sweep, unsigned plane)
{
    late_in_a_row_ = 0;
    if (held_ & plane_bit(plane))
        lost_ += sweep - sweep_[plane] - 1;
    sweep_[plane] = sweep;
    held_ |= plane_bit(plane);

    if (sweep > newest_->sweep)
        newest_ = Newest{sweep, plane, {planes_, plane}};
    else if (sweep < newest_->sweep || newest_->direction.before(plane, newest_->plane))
        reordered_++;
    else
        newest_->plane = plane;
}

uint64_t RollingWindow::stale() const
{
    uint64_t planes = 0;
    for (unsigned z = 0; z < planes_; z++)
        if ((held_ & plane_bit(z)) && passed(sweep_[z], z))
            planes |= plane_bit(z);
    return planes;
}

} // namespace dff
