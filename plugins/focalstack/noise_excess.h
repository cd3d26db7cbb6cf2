/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <array>
#include <opencv2/core.hpp>

namespace dff {

/* A picture and what it is compared with, of one channel, and the noise of one of its pixels at 256
 * brightnesses, as a standard deviation. */
struct ComparedChannel {
    const cv::Mat1f &picture;
    const cv::Mat1f &before;
    const std::array<float, 256> &noise;
};

/* Sets mask to 1 where |mean of picture - before over 3x3 pixels| lies by more than `margin` above what noise
 * explains, 3.5 standard deviations: in pixels of `where`, and adds to what other channels have set. `before`
 * is the mean of as many sweeps as `sweeps` says, 16 at most, or of one. Gives the rectangle of what it set.
 */
cv::Rect mark_excess(const ComparedChannel &channel, const cv::Mat1b *sweeps, float margin,
                     const cv::Rect &where, cv::Mat1b &mask);

} // namespace dff
