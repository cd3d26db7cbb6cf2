/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/program.h"
#include "engine/opencl/stack_buffer.h"

namespace dff {

/* The noise of a stack (Immerkaer 1996), which constants of later stages slide with: see kernels/noise.cl. It
 * stays on the device. */
class NoiseEstimate {
public:
    /* `scale` of the volume, which the pre-blur goes by. */
    NoiseEstimate(CommandQueue &queue, const StackShape &shape, cl_int scale);

    /* Where most planes are the last stack's, the pre-blur stays while it is nearly right. What is told with
     * the stack is not measured. */
    void run(const StackBuffer &stack);

    const cl::Buffer &noise() const { return noise_; } /* one Noise of low_picture.cl */

    /* Laid out as the kernels' Noise. */
    struct Noise {
        cl_float sigma; /* DN */
        cl_float t;     /* sigma^2 / (sigma^2 + 1) */
        cl_int taps[4]; /* of the pre-blur, in 1/64 */
        cl_int is_new;  /* the pre-blur is another than the last stack's */
    };

private:
    CommandQueue &queue_;
    StackShape shape_;
    cl_int scale_;
    cl::Kernel plane_noise_, judge_noise_;
    cl::Buffer histograms_, sigmas_, noise_;
    cl_ulong unmeasured_ = 0; /* planes that came since while their noise was told */
};

} // namespace dff
