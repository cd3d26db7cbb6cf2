/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "camera_clock.h"

#include <chrono>

namespace dff {

uint64_t monotonic_ns()
{
    /* libstdc++'s steady_clock is CLOCK_MONOTONIC. */
    return static_cast<uint64_t>(
        std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count());
}

} // namespace dff
