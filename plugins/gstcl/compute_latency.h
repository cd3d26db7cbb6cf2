/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

namespace dff {

/* The latency of an element that computes one stack after the other: the longest time it has computed, except
 * for first stacks that waited for the compiler of their kernels, which happens once on a device. */
class ComputeLatency {
public:
    /* Takes how long a stack was computed, and whether it was the first one of an engine. Returns true if the
     * latency is notably longer now, and so has to be announced. */
    bool add(GstClockTime compute_time, bool is_first)
    {
        if ((is_first && compute_time > longest_start) ||
            compute_time <= latency_ + latency_ / 4 + GST_MSECOND)
            return false;
        latency_ = compute_time;
        return true;
    }

    GstClockTime get() const { return latency_; }
    void reset() { latency_ = 0; }

private:
    static constexpr GstClockTime longest_start = 500 * GST_MSECOND; /* with kernels compiled before */

    GstClockTime latency_ = 0;
};

} // namespace dff
