/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

namespace dff {

/* Fractal value noise in three dimensions, about 0..1 with mean 0.5. Its coarsest wave has length 1, its
 * finest `detail`; each octave has `persistence` of the contrast of the one before. An octave repeats itself
 * after 256 of its waves. */
class FractalNoise {
public:
    FractalNoise(uint64_t seed, double detail, double persistence = 0.7);

    double operator()(const cv::Vec3d &point) const;

private:
    double smooth(const cv::Vec3d &point) const;

    std::array<uint8_t, 256> shuffled_;
    std::array<float, 256> values_;
    int octaves_;
    double persistence_;
    double normalisation_;
};

} // namespace dff
