/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "exposure_clock.h"

#include <algorithm>

namespace dff {

namespace {

constexpr std::int64_t drift_ppm = 200;
constexpr std::int64_t jump_ns = 1'000'000'000;

} // namespace

std::int64_t ExposureClock::exposed_ns(const CameraFrame &frame, std::int64_t delay_ns)
{
    if (frame.camera_ns == 0)
        return frame.arrival_ns - delay_ns;
    const std::int64_t offset_ns = frame.arrival_ns - frame.camera_ns;
    const std::int64_t drift_ns = (frame.arrival_ns - last_ns_) / 1'000'000 * drift_ppm;
    last_ns_ = frame.arrival_ns;
    const bool jumped = offset_ns_ && offset_ns > *offset_ns_ + drift_ns + jump_ns;
    if (offset_ns_ && !jumped)
        offset_ns_ = std::min(*offset_ns_ + drift_ns, offset_ns);
    else
        offset_ns_ = offset_ns;
    return frame.camera_ns + *offset_ns_ - delay_ns;
}

} // namespace dff
