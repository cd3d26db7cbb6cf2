/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/cpu/cpu_paper_method.h"

namespace dff {

CpuPaperMethod::CpuPaperMethod(CommandQueue &queue, const StackShape &shape,
                               const DepthParameters &parameters)
    : queue_(queue), shape_(shape), motion_mask_(parameters.motion_mask), luma_(queue, shape),
      focus_(queue, shape, parameters.levels, parameters.tolerance, parameters.entropy_bits),
      grid_(queue, shape.width, shape.height, parameters.grid), slice_(queue, shape, grid_)
{
}

void CpuPaperMethod::run(const StackBuffer &stack, DepthCoder &coder, const Wanted &wanted,
                         const cl::Buffer &depth)
{
    luma_.run(stack);
    focus_.run(luma_, motion_mask_, wanted.confidence);
    grid_.run(focus_.places(), focus_.mean());
    slice_.run(grid_, focus_.mean(), coder, depth);
    if (wanted.sparse) {
        if (!sparse_depth_())
            sparse_depth_ = queue_.allocate(size_t{shape_.width} * shape_.height * sizeof(cl_ushort));
        coder.code_places(focus_.places(), sparse_depth_);
    }
}

} // namespace dff
