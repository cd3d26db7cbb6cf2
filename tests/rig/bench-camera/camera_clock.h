/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>

namespace dff {

/* The camera's own clock, as its timestamps tell it. */
struct CameraClock {
    int64_t offset_ns = 0;
    double drift_ppm = 0.0; /* how much faster it runs than CLOCK_MONOTONIC */

    uint64_t at(uint64_t monotonic_ns) const
    {
        const auto drift = static_cast<int64_t>(static_cast<double>(monotonic_ns) * drift_ppm * 1e-6);
        return monotonic_ns + static_cast<uint64_t>(offset_ns + drift);
    }
};

/* CLOCK_MONOTONIC in nanoseconds. */
uint64_t monotonic_ns();

} // namespace dff
