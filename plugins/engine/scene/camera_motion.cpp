/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/camera_motion.h"

#include "engine/scene/seeds.h"

#include <cmath>
#include <numbers>

namespace dff {

namespace {

/* In planes: 4, 7 and 11 waves a second where 160 planes are taken in one, as hands shake. */
constexpr double periods[] = {40.0, 23.0, 14.5};

} // namespace

CameraMotion::CameraMotion(double pan, double shake, uint64_t seed) : pan_(pan), shake_(shake), seed_(seed) {}

/* Waves of equal power, whose phases are drawn. */
double CameraMotion::shake(double time, uint64_t axis) const
{
    if (shake_ == 0.0)
        return 0.0;
    cv::RNG random(mix_seed(seed_, axis));
    double sum = 0.0;
    for (const double period : periods)
        sum += std::sin(2.0 * std::numbers::pi * (time / period + random.uniform(0.0, 1.0)));
    return shake_ * std::sqrt(2.0 / std::size(periods)) * sum;
}

cv::Point2d CameraMotion::offset(double time) const
{
    return {pan_ * time + shake(time, 0), shake(time, 1)};
}

cv::Vec2d CameraMotion::velocity(double time) const
{
    constexpr double step = 0.01; /* planes */
    return cv::Vec2d(offset(time + step) - offset(time - step)) / (2.0 * step);
}

WorldPixel world_pixel(double place, int length)
{
    const double world = 2.0 * length;
    const int at = static_cast<int>(std::lround(place - world * std::floor(place / world))) % (2 * length);
    return {at < length ? at : 2 * length - 1 - at, at >= length};
}

} // namespace dff
