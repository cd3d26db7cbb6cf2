/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <optional>

namespace dff {

/* Numbers the sweeps of a source that takes one plane of each. Where time and rate are known a frame that was
 * lost leaves a gap; the step is measured from frame to frame, so that a clock that drifts does no harm. */
class FrameNumbering {
public:
    /* The sweep of the next frame. `time_ns` is its running time, `period_ns` the time between frames, 0
     * where unknown; `origin_ns` is the time of sweep 0. */
    uint64_t next(std::optional<uint64_t> time_ns, uint64_t period_ns, uint64_t origin_ns);

private:
    std::optional<uint64_t> last_;
    std::optional<uint64_t> last_time_ns_;
};

} // namespace dff
