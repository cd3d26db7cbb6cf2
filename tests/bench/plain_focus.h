/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <span>

namespace dff::bench {

/* The paper's focus measure (2) on three levels with its maximum and mean over the planes, as one would write
 * it in C++ for one thread. luma holds planes x height x width; returns the sum of the means, so that nothing
 * is left out by the compiler. */
double plain_focus_measure(std::span<const uint8_t> luma, int width, int height, int planes);

} // namespace dff::bench
