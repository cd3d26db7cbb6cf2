/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/depth_coder.h"
#include "engine/opencl/stack_buffer.h"

namespace dff {

/* A way from a stack to its maps. Every map has the picture's full size. */
class DepthMethod {
public:
    /* The maps beside depth that a stack is asked for; the others cost nothing. */
    struct Wanted {
        bool sparse = false;
        bool confidence = false;
        bool motion = false;
        bool uncertainty = false;
    };

    virtual ~DepthMethod() = default;

    /* Queues all stages. `depth` takes ushort[height][width], 0 everywhere if nothing could be told. */
    virtual void run(const StackBuffer &stack, DepthCoder &coder, const Wanted &wanted,
                     const cl::Buffer &depth) = 0;

    virtual const cl::Buffer &sparse() const = 0;     /* ushort, 0 where unknown */
    virtual const cl::Buffer &confidence() const = 0; /* uchar: 255 c */
    virtual const cl::Buffer &motion() const = 0;     /* uchar: 255 where it moved */

    /* ushort: one standard deviation, in steps of the depth map; nullptr where the method tells none. */
    virtual const cl::Buffer *uncertainty() const { return nullptr; }

    /* By how many pixels the circle of confusion grows from plane to plane in the last stack; 0 where that is
     * not known. */
    virtual float blur_step() const { return 0.0f; }

    /* float: the residual the solver left, in parts of the right-hand side; nullptr where that is not known.
     */
    virtual const cl::Buffer *residual() const { return nullptr; }
};

} // namespace dff
