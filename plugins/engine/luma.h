/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/program.h"
#include "engine/opencl/stack_buffer.h"

namespace dff {

/* The luma of a stack, which every later stage reads: in place where the format has it (gray, I420, NV12),
 * computed from the colours (BT.601), in as many bits as they have, otherwise. */
class Luma {
public:
    Luma(CommandQueue &queue, const StackShape &shape);

    void run(const StackBuffer &stack);

    const cl::Buffer &bytes() const { return bytes_; }
    const cl::Buffer &rows() const { return rows_; }

    /* Options for kernels that read luma with luma_at(). */
    static std::string build_options(PixelFormat format);

private:
    CommandQueue &queue_;
    StackShape shape_;
    cl::Kernel kernel_;
    cl::Buffer bytes_;
    cl::Buffer rows_;
};

/* How the kernels find the colours: of an interleaved format samples a pixel and indices of R, G, B; of NV12
 * and I420 step and index of U, step and index of V in their components. */
cl_int4 colour_channels(PixelFormat format);

/* Options for kernels that read colours: INTERLEAVED and CHANNELS, or CHROMA and V_COMPONENT, or neither.
 * With those of Luma::build_options. */
std::string colour_options(PixelFormat format);

/* Whether the format's pixels are interleaved colours. */
bool is_interleaved(PixelFormat format);

} // namespace dff
