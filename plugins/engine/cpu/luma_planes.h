/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/program.h"
#include "engine/opencl/stack_buffer.h"

namespace dff {

/* The luma of a stack in 8 bits, for the CPU's kernels: in place where the format has it (GRAY8, I420, NV12),
 * otherwise computed from the colours (BT.601), rounded from 16 bits, or both. */
class LumaPlanes {
public:
    LumaPlanes(CommandQueue &queue, const StackShape &shape);

    void run(const StackBuffer &stack);

    const cl::Buffer &bytes() const { return bytes_; }
    const cl::Buffer &rows() const { return rows_; } /* ulong2 (offset, stride) for each plane */

private:
    CommandQueue &queue_;
    StackShape shape_;
    bool in_place_;
    cl::Kernel kernel_;
    cl::Buffer bytes_, rows_;
};

} // namespace dff
