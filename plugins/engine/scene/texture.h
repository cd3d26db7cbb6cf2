/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace dff {

/* Fractal value noise in three dimensions, about 0..1 with mean 0.5. `detail` is the length of its finest
 * wave, its coarsest is 1; each octave has `persistence` of the contrast of the one before. */
class FractalNoise {
public:
    FractalNoise(uint64_t seed, double detail, double persistence = 0.7);

    double operator()(const cv::Vec3d &point) const;

private:
    double lattice(int64_t x, int64_t y, int64_t z) const;
    double smooth(const cv::Vec3d &point) const;

    uint64_t seed_;
    int octaves_;
    double persistence_;
};

} // namespace dff
