/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string_view>

namespace dff {

/* Noise of a sensor, Poisson (photons) and Gaussian (read-out): variance = gain I + read^2, in 8-bit values.
 */
struct SensorNoise {
    double gain = 0.0;
    double read = 0.0;

    bool silent() const { return gain <= 0.0 && read <= 0.0; }

    /* "none", "mild" (0.05,1), "moderate" (0.2,2), "strong" (1,5) or "GAIN,READ" with numbers from 0 to 255;
     * empty if it is none of these. */
    static std::optional<SensorNoise> parse(std::string_view text);

    /* The picture as the sensor digitises it: noise is added, then the sum is clipped to 0..255 and rounded.
     * The same `seed` gives the same noise. Runs on all cores. */
    cv::Mat3b digitise(const cv::Mat3f &picture, uint64_t seed) const;
};

} // namespace dff
