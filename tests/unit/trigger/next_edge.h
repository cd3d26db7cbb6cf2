/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lenssweep/trigger/lines.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <poll.h>

/* The next edge of a line, or nothing if none comes in time. */
inline std::optional<dff::LineEdge> next_edge(dff::EdgeLine &line, std::chrono::milliseconds time)
{
    const auto end = std::chrono::steady_clock::now() + time;
    while (true) {
        if (const auto edge = line.read())
            return edge;
        const auto left =
            std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        if (left.count() <= 0)
            return std::nullopt;
        pollfd waited{line.descriptor(), POLLIN, 0};
        poll(&waited, 1, static_cast<int>(left.count()));
    }
}
