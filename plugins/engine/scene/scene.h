/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <opencv2/core.hpp>

namespace dff {

/* A sharp picture and how deep each of its pixels lies within the sweep. */
struct Scene {
    cv::Mat3b color; /* R, G, B */
    cv::Mat1f depth; /* 0 = near end of the sweep, 1 = its far end, linear in dioptres; beyond: outside */
    cv::Mat1b known; /* 0 where the depth is a guess; empty: known everywhere */

    cv::Size size() const { return color.size(); }
};

} // namespace dff
