/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>

namespace dff {

struct MuxStatistics {
    uint64_t frames = 0;    /* came in */
    uint64_t stacks = 0;    /* were sent */
    uint64_t dropped = 0;   /* stacks that were not sent, for planes missing */
    uint64_t lost = 0;      /* frames that never came */
    uint64_t repeated = 0;  /* frames that came twice; the second one is not used */
    uint64_t late = 0;      /* frames that came when their sweep was over; not used */
    uint64_t reordered = 0; /* frames that came out of order and were put in their place */
    uint64_t damaged = 0;   /* frames that could not be read; count as lost too */

    /* Planes that are missing in each stack dropped since one was sent; bit z is plane z. */
    uint64_t never_there = ~uint64_t{0};
};

} // namespace dff
