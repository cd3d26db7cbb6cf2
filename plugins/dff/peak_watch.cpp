/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "peak_watch.h"

#include <algorithm>

namespace dff {

namespace {

/* Planes that differ by their noise alone give method=volume a confidence of 0.09 at most (noise of 0 to 8
 * DN, brightness of 5 % up and down); a sweep, strong noise in it too, gives one pixel in a thousand 0.25 or
 * more. */
constexpr auto least_peak = std::byte{31}; /* 255 c, c = 0.12 */
constexpr size_t pixels_a_peak = 1000;

} // namespace

bool PeakWatch::has_peaks(const std::byte *confidence, size_t stride, size_t width, size_t height)
{
    size_t peaks = 0;
    for (size_t y = 0; y < height; y++)
        peaks += static_cast<size_t>(std::count_if(confidence + y * stride, confidence + y * stride + width,
                                                   [](std::byte c) { return c > least_peak; }));
    return peaks >= std::max(width * height / pixels_a_peak, size_t{1});
}

} // namespace dff
