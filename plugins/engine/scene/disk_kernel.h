/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <opencv2/core.hpp>

namespace dff {

/* Circles of confusion below this diameter count as sharp. */
constexpr double sharp_diameter = 0.3;

/* Whole pixels a disk of this diameter reaches to each side; 0 if it counts as sharp. */
int disk_reach(double diameter);

/* A uniform disk of `diameter` pixels, antialiased 8 x 8 times, of sum 1 and 2 disk_reach() + 1 pixels wide.
 * Empty if it counts as sharp. */
cv::Mat1f disk_kernel(double diameter);

} // namespace dff
