/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/low_shape.h"

#include <span>

namespace dff {

/* Separable symmetric filters of low pictures. */
class LowFilter {
public:
    /* `taps` from the centre outward. With a `noise` of NoiseEstimate, does nothing in silence. */
    LowFilter(CommandQueue &queue, const LowShape &low, std::span<const float> taps,
              const cl::Buffer &noise = cl::Buffer());

    static std::vector<float> box(unsigned radius);
    static std::vector<float> gaussian(unsigned radius, float sigma);

    /* Filters `pictures` low pictures; `between` is room for as many. */
    void run(const cl::Buffer &source, const cl::Buffer &between, const cl::Buffer &filtered,
             size_t pictures);

    /* Mirrors the cells at the ends of each row into its sides, for kernels that look beside a cell. */
    void mirror_sides(const cl::Buffer &volume, size_t pictures);

private:
    CommandQueue &queue_;
    LowShape low_;
    cl::Kernel mirror_sides_, filter_columns_, filter_rows_;
    cl::Buffer taps_, noise_;
    cl_int radius_;
};

} // namespace dff
