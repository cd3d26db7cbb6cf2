/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <opencv2/core.hpp>

#include "focalstack/plane_warp.h"

namespace dff {

/* What speaks for a warp and against it: correlations with it as it is, and with its strongest rival, the
 * same warp after a shift. */
struct ShiftRival {
    double own = 1.0;
    double others = 0.0;
    cv::Point2d shift; /* of the rival, in pixels */

    /* Whether the rival explains the picture better, or as well unless the warp hardly moves it: of a pattern
     * that repeats only a camera that stands still can be believed. */
    bool wins(const PlaneWarp &warp, cv::Size size) const;
};

/* Correlates `from` with what `to` shows without the warp, both 8-bit bands, at all shifts of up to a fifth
 * of the picture. */
ShiftRival strongest_rival(const cv::Mat &from, const cv::Mat &to, const PlaneWarp &warp);

} // namespace dff
