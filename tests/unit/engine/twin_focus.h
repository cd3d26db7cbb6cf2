/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "test_stack.h"

namespace dff::twin {

/* Plain C++ versions of the kernels of the same names, written for reading. */

Volume luma(const TestStack &stack);

struct Focus {
    Volume peak, mean;
    std::vector<uint8_t> place;
};
Focus focus_product(const Volume &luma, unsigned levels);

std::vector<uint8_t> z_entropy(const Volume &luma, float threshold_bits);

std::vector<uint8_t> sparse_depth(const Focus &focus, const std::vector<uint8_t> *moved, float tolerance);

std::vector<uint8_t> mean_luma(const Volume &luma);

Volume gaussian_blur(const Volume &picture, const std::vector<float> &taps);

} // namespace dff::twin
