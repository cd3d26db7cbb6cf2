/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <algorithm>
#include <chrono>

namespace dff {

/* How long to wait before the next try: 0.5 s, and twice as long after each failure, up to 10 s. */
class BackOff {
public:
    std::chrono::milliseconds next()
    {
        const std::chrono::milliseconds wait = wait_;
        wait_ = std::min(2 * wait_, longest);
        return wait;
    }

    void succeeded() { wait_ = shortest; }

private:
    static constexpr std::chrono::milliseconds shortest{500};
    static constexpr std::chrono::milliseconds longest{10000};

    std::chrono::milliseconds wait_ = shortest;
};

} // namespace dff
