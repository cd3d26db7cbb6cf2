/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <chrono>
#include <stop_token>

namespace dff {

/* Waits for a file descriptor, and can be woken from any thread. */
class DescriptorWait {
public:
    /* Throws LineError. */
    DescriptorWait();
    ~DescriptorWait();
    DescriptorWait(const DescriptorWait &) = delete;
    DescriptorWait &operator=(const DescriptorWait &) = delete;

    /* What poll() says of the descriptor once it can be read or has failed; 0 when `timeout` (at most a day)
     * has passed or `stop` is requested. */
    short wait(int descriptor, const std::stop_token &stop, std::chrono::nanoseconds timeout) const;

private:
    int stopped_; /* an eventfd */
};

} // namespace dff
