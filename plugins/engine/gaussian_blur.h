/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/command_queue.h"
#include "engine/opencl/program.h"
#include "engine/stack_shape.h"

namespace dff {

/* Separable Gaussian of a float picture, mirrored at the borders. */
class GaussianBlur {
public:
    /* The paper's last step: round(1.2 sigma_xy) taps (the next odd number), sigma = 0.7 * 1.2 sigma_xy. */
    static std::vector<float> taps_for(unsigned sigma_xy);

    GaussianBlur(CommandQueue &queue, uint32_t width, uint32_t height, std::span<const float> taps);

    /* Blurs float[height][width] in place. */
    void run(const cl::Buffer &picture);

private:
    CommandQueue &queue_;
    uint32_t width_, height_;
    cl_int radius_;
    cl::Kernel blur_rows_, blur_columns_;
    cl::Buffer taps_, half_blurred_;
};

} // namespace dff
