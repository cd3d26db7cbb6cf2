/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>

namespace dff {

/* CLOCK_MONOTONIC in nanoseconds. */
std::int64_t host_now_ns();

/* What a capture waits in, for all that it waits for. */
class CapturePoll {
public:
    /* Throws CameraError. */
    CapturePoll();
    ~CapturePoll();
    CapturePoll(const CapturePoll &) = delete;
    CapturePoll &operator=(const CapturePoll &) = delete;

    /* Ends the wait that is under way, or else the next one. From any thread, and never waits. */
    void wake() noexcept;

    /* Until it is woken, the descriptor (-1: none) can be read or has failed, or the host's CLOCK_MONOTONIC
     * passes `deadline_ns`. Whoever wakes it changes first what the waiting thread looks at after this. */
    void wait(int descriptor, std::int64_t deadline_ns) noexcept;

private:
    int woken_; /* an eventfd */
};

} // namespace dff
