/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "optics/depth_scale.h"

#include <vector>

namespace dff {

/* The distance in metres of each of the 65536 pixels: NaN for "no value", infinite for 0 dioptres and below.
 * In the unit micrometre it is the stage position, in the unit index the plane position instead, which is no
 * distance. */
std::vector<float> distance_table(const DepthScale &scale);

/* How many of these metres the distance changes by from a pixel to the next, around each of them: what a
 * standard deviation in pixels is multiplied by. NaN for "no value", infinite where the distance is. */
std::vector<float> distance_slope_table(const DepthScale &scale);

} // namespace dff
