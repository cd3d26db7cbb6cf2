/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/cpu/luma_grid.h"
#include "engine/depth_coder.h"

namespace dff {

/* From the solution in the grid to the depth map, on the CPU: slice, Gaussian and coding in one pass. */
class DepthSlice {
public:
    DepthSlice(CommandQueue &queue, const StackShape &shape, const LumaGrid &grid);

    /* Writes depth ushort[height][width] of the picture whose luma uchar[height][width] chose the cells. */
    void run(const LumaGrid &grid, const cl::Buffer &luma, const DepthCoder &coder, const cl::Buffer &depth);

private:
    CommandQueue &queue_;
    StackShape shape_;
    cl::Kernel kernel_;
    cl::Buffer weights_;
};

} // namespace dff
