/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <opencv2/core.hpp>

namespace dff {

/* Colours are R, G, B in 0..1. */
using Color = cv::Vec3d;

/* A soft rainbow that repeats with `hue` = 1. */
Color rainbow(double hue);

/* Clipped and rounded to 8 bits. */
cv::Vec3b to_pixel(const Color &color);

} // namespace dff
