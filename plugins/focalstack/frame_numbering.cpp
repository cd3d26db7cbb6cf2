/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/frame_numbering.h"

#include <algorithm>

namespace dff {

static uint64_t periods_between(uint64_t from_ns, uint64_t to_ns, uint64_t period_ns)
{
    return to_ns > from_ns ? (to_ns - from_ns + period_ns / 2) / period_ns : 0;
}

uint64_t FrameNumbering::next(std::optional<uint64_t> time_ns, uint64_t period_ns, uint64_t origin_ns)
{
    const bool timed = time_ns && period_ns > 0;
    if (!last_)
        last_ = timed ? periods_between(origin_ns, *time_ns, period_ns) : 0;
    else if (timed && last_time_ns_)
        *last_ += std::max<uint64_t>(1, periods_between(*last_time_ns_, *time_ns, period_ns));
    else
        ++*last_;
    last_time_ns_ = time_ns;
    return *last_;
}

} // namespace dff
