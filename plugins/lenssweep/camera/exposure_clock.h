/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "plane_labeller.h"

#include <cstdint>
#include <optional>

namespace dff {

/* When frames were exposed, from when they arrived. Arrivals are jittery and never early; where the camera
 * has a clock, its times with the least delay seen are used. The clocks may drift by 200 ppm. */
class ExposureClock {
public:
    /* Start of the exposure by the host's CLOCK_MONOTONIC. `delay_ns`: from there to the arrival at the
     * least. */
    std::int64_t exposed_ns(const CameraFrame &frame, std::int64_t delay_ns);

private:
    std::optional<std::int64_t> offset_ns_; /* arrival - camera, at the least */
    std::int64_t last_ns_ = 0;
};

} // namespace dff
