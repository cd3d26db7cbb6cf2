/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "test_stack.h"

namespace dff::twin {

/* Plain C++ version of sharp_weights.cl and sharp_blend.cl, written for reading: the samples of each
 * component of the picture of AifComposer::Blend::Sharp, not yet rounded. `positions`: of each pixel, below 0
 * where there is none. */
std::vector<std::vector<double>> sharp_picture(const TestStack &stack, const std::vector<double> &positions);

} // namespace dff::twin
