/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <span>

namespace dff::bench {

/* The paper's focus measure (2) on three levels with its maximum and mean over the planes, by OpenCV's
 * functions. luma holds planes x height x width; returns a sum, so that nothing is left out. */
double opencv_focus_measure(std::span<const uint8_t> luma, int width, int height, int planes);

/* Which pixels moved, by the entropy along z (3) in bins of 16 DN: how many. */
double opencv_entropy(std::span<const uint8_t> luma, int width, int height, int planes);

} // namespace dff::bench
