/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "monotonic_lead.h"

#include <chrono>

GstClockTimeDiff monotonic_lead(GstClock *clock)
{
    constexpr int attempts = 8;
    constexpr GstClockTimeDiff close_enough = 20 * GST_USECOND;
    GstClockTimeDiff closest = G_MAXINT64;
    GstClockTimeDiff lead = 0;
    for (int attempt = 0; attempt < attempts && closest > close_enough; attempt++) {
        const GstClockTime before = gst_clock_get_time(clock);
        const GstClockTimeDiff monotonic =
            std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
        const GstClockTimeDiff passed = GST_CLOCK_DIFF(before, gst_clock_get_time(clock));
        if (passed >= closest)
            continue;
        closest = passed;
        lead = monotonic - static_cast<GstClockTimeDiff>(before) - passed / 2;
    }
    return lead;
}
