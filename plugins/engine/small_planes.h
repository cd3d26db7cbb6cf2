/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/low_shape.h"
#include "engine/opencl/program.h"
#include "engine/opencl/stack_buffer.h"

namespace dff {

/* The planes of a stack area-downsampled, in R, G, B. */
class SmallPlanes {
public:
    SmallPlanes(CommandQueue &queue, const StackShape &shape, const LowShape &low);

    /* Computes the planes that have changed. */
    void run(const StackBuffer &stack);

    const cl::Buffer &colours() const { return colours_; } /* low pictures short [z][R, G, B] */

private:
    CommandQueue &queue_;
    LowShape low_;
    cl_int4 channels_;
    cl::Kernel average_colours_;
    cl::Buffer colours_;
};

} // namespace dff
