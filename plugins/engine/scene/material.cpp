/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/material.h"

#include <cmath>
#include <numbers>

namespace dff {

namespace {

Color blend(const Color &first, const Color &second, double t)
{
    return first + (second - first) * t;
}

bool odd(double cell)
{
    return std::fmod(std::abs(cell), 2.0) >= 1.0;
}

} // namespace

Color Material::color(const cv::Vec3d &point) const
{
    if (pattern == Pattern::Plain)
        return first;
    const cv::Vec3d p = point / wave;
    const double noise = grain(p);
    /* The grain runs through every textured surface, so that it can be focused on everywhere. */
    const double shade = 0.35 + 1.1 * noise;
    const double around = std::atan2(p[2], p[0]) / (2.0 * std::numbers::pi) + 0.5;
    switch (pattern) {
    case Pattern::Marble:
        return blend(first, second,
                     0.5 + 0.5 * std::sin(2.0 * std::numbers::pi * (p[0] + p[1] + 1.5 * noise))) *
               shade;
    case Pattern::Segments:
        return (odd(std::floor(8.0 * around)) ? first : second) * shade;
    case Pattern::Checks:
        return (odd(std::floor(p[0]) + std::floor(p[1] + 0.01) + std::floor(p[2])) ? first : second) * shade;
    case Pattern::Stripes:
        return (odd(std::floor(2.0 * p[1] + 0.5)) ? first : second) * shade;
    default:
        return rainbow(0.5 * p[0] + 0.2 * p[1] + 0.6 * noise) * shade;
    }
}

} // namespace dff
