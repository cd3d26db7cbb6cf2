/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>

namespace dff {

/* A sweep as the triggers give it. Times are nanoseconds. */
struct SweepTiming {
    unsigned planes = 0;
    std::int64_t period_ns = 0; /* from one exposure to the next within a sweep */
    std::int64_t sweep_ns = 0;  /* from plane 0 to plane 0: the planes' periods and the lens's way back */
    std::int64_t exposure_ns = 0;
    std::int64_t transfer_ns = 0; /* what the link needs for a frame at the least; 0: not known */

    /* How far two clocks may differ about a trigger and still agree. */
    std::int64_t tolerance_ns() const { return period_ns / 4; }
};

} // namespace dff
