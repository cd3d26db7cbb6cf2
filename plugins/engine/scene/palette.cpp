/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/palette.h"

#include <cmath>
#include <numbers>

namespace dff {

Color rainbow(double hue)
{
    const auto wave = [&](double phase) {
        return 0.6 + 0.4 * std::cos(2.0 * std::numbers::pi * (hue - phase));
    };
    return {wave(0.0), wave(1.0 / 3.0), wave(2.0 / 3.0)};
}

cv::Vec3b to_pixel(const Color &color)
{
    return {cv::saturate_cast<uchar>(255.0 * color[0]), cv::saturate_cast<uchar>(255.0 * color[1]),
            cv::saturate_cast<uchar>(255.0 * color[2])};
}

} // namespace dff
