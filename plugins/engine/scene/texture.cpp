/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/texture.h"

#include "engine/scene/seeds.h"

#include <algorithm>
#include <cmath>

namespace dff {

namespace {

double ease(double t)
{
    return t * t * (3.0 - 2.0 * t);
}

} // namespace

FractalNoise::FractalNoise(uint64_t seed, double detail, double persistence)
    : seed_(seed), octaves_(std::clamp(static_cast<int>(std::ceil(-std::log2(detail))) + 1, 1, 12)),
      persistence_(persistence)
{
}

double FractalNoise::lattice(int64_t x, int64_t y, int64_t z) const
{
    const auto cell = static_cast<uint64_t>(x * 73856093 ^ y * 19349663 ^ z * 83492791);
    return static_cast<double>(mix_seed(seed_, cell) >> 11) * 0x1p-53;
}

double FractalNoise::smooth(const cv::Vec3d &point) const
{
    const double fx = std::floor(point[0]);
    const double fy = std::floor(point[1]);
    const double fz = std::floor(point[2]);
    const double tx = ease(point[0] - fx);
    const double ty = ease(point[1] - fy);
    const double tz = ease(point[2] - fz);
    const auto x = static_cast<int64_t>(fx);
    const auto y = static_cast<int64_t>(fy);
    const auto z = static_cast<int64_t>(fz);
    const auto row = [&](int64_t dy, int64_t dz) {
        return std::lerp(lattice(x, y + dy, z + dz), lattice(x + 1, y + dy, z + dz), tx);
    };
    return std::lerp(std::lerp(row(0, 0), row(1, 0), ty), std::lerp(row(0, 1), row(1, 1), ty), tz);
}

double FractalNoise::operator()(const cv::Vec3d &point) const
{
    double sum = 0.0;
    double weights = 0.0;
    double weight = 1.0;
    double frequency = 1.0;
    for (int octave = 0; octave < octaves_; octave++) {
        sum += weight * (smooth(point * frequency) - 0.5);
        weights += weight * weight;
        weight *= persistence_;
        frequency *= 2.0;
    }
    /* Octaves are independent: dividing by the root of the summed squares keeps the contrast of one. */
    return 0.5 + sum / std::sqrt(weights);
}

} // namespace dff
