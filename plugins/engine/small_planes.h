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

    void run(const StackBuffer &stack);

    const cl::Buffer &colours() const { return colours_; } /* low pictures [z][R, G, B] */

private:
    struct Averaging {
        cl::Kernel kernel;
        cl_int first_row; /* of the table of rows */
        cl_int width;     /* pixels of the component */
        cl_int4 places;   /* which colour a channel is */
    };

    void average(size_t component, const Component &shape, cl_int4 places);

    CommandQueue &queue_;
    StackShape shape_;
    LowShape low_;
    std::vector<Averaging> averagings_;
    cl::Kernel convert_;
    cl::Buffer colours_;
};

} // namespace dff
