/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/low_shape.h"
#include "engine/opencl/program.h"

namespace dff {

/* The depth a picture is taken at beside what is nearer, where planes lie far apart: see
 * kernels/depth_reach.cl. */
class DepthReach {
public:
    DepthReach(CommandQueue &queue, const StackShape &shape);

    /* Whether blur reaches farther than kernels/soften_depth.cl looks. */
    static bool is_needed(float blur_step) { return blur_step > least_step; }

    /* `depth`: ushort[height][stride]; what comes back is packed. blur_step: pixels a plane. */
    const cl::Buffer &run(const cl::Buffer &depth, size_t stride, float blur_step);

private:
    static constexpr float least_step = 3.0f;

    CommandQueue &queue_;
    StackShape shape_;
    LowShape blocks_;
    cl::Kernel nearest_of_blocks_, spread_nearest_, limit_depth_;
    cl::Buffer nearest_[2], limited_;
};

} // namespace dff
