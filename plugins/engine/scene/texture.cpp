/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/texture.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dff {

namespace {

/* std::floor is a library call on plain x86-64, and this is the innermost loop. */
int floor_of(double x)
{
    const int whole = static_cast<int>(x);
    return whole - (x < whole);
}

double ease(double t)
{
    return t * t * (3.0 - 2.0 * t);
}

double between(double a, double b, double t)
{
    return a + (b - a) * t;
}

} // namespace

FractalNoise::FractalNoise(uint64_t seed, double detail, double persistence)
    : octaves_(std::clamp(static_cast<int>(std::ceil(-std::log2(detail))) + 1, 1, 12)),
      persistence_(persistence)
{
    cv::RNG random(seed);
    std::iota(shuffled_.begin(), shuffled_.end(), uint8_t{0});
    for (unsigned i = 255; i > 0; i--)
        std::swap(shuffled_[i], shuffled_[random(i + 1)]);
    std::generate(values_.begin(), values_.end(), [&] { return random.uniform(-0.5F, 0.5F); });
    /* Octaves are independent: dividing by the root of the summed squares keeps the contrast of one. */
    double squares = 0.0;
    for (int octave = 0; octave < octaves_; octave++)
        squares += std::pow(persistence_, 2 * octave);
    normalisation_ = 1.0 / std::sqrt(squares);
}

/* One octave: random values at whole numbers, eased in between. */
double FractalNoise::smooth(const cv::Vec3d &point) const
{
    const int x = floor_of(point[0]);
    const int y = floor_of(point[1]);
    const int z = floor_of(point[2]);
    const double tx = ease(point[0] - x);
    const double ty = ease(point[1] - y);
    const double tz = ease(point[2] - z);
    const auto row = [&](int dy, int dz) {
        const int start = shuffled_[(shuffled_[(z + dz) & 255] + y + dy) & 255] + x;
        return between(values_[shuffled_[start & 255]], values_[shuffled_[(start + 1) & 255]], tx);
    };
    return between(between(row(0, 0), row(1, 0), ty), between(row(0, 1), row(1, 1), ty), tz);
}

double FractalNoise::operator()(const cv::Vec3d &point) const
{
    double sum = 0.0;
    double weight = normalisation_;
    double frequency = 1.0;
    for (int octave = 0; octave < octaves_; octave++) {
        sum += weight * smooth(point * frequency);
        weight *= persistence_;
        frequency *= 2.0;
    }
    return 0.5 + sum;
}

} // namespace dff
