/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/paper_method.h"

namespace dff {

PaperMethod::PaperMethod(CommandQueue &queue, const StackShape &shape, const DepthParameters &parameters)
    : queue_(queue), shape_(shape), motion_mask_(parameters.motion_mask), luma_(queue, shape),
      focus_(queue, shape, parameters.levels), entropy_(queue, shape, parameters.entropy_bits),
      sparse_(queue, shape, parameters.tolerance),
      reference_(queue, shape, parameters.grid.sigma_chroma != 0), grid_(queue, shape, parameters.grid),
      blur_(queue, shape.width, shape.height, GaussianBlur::taps_for(parameters.grid.sigma_xy))
{
}

void PaperMethod::run(const StackBuffer &stack, DepthCoder &coder, const Wanted &wanted,
                      const cl::Buffer &depth)
{
    luma_.run(stack);
    focus_.run(luma_);
    if (motion_mask_ || wanted.motion)
        entropy_.run(luma_);
    sparse_.run(focus_, motion_mask_ ? &entropy_ : nullptr);
    reference_.run(stack, luma_);
    grid_.run(sparse_, reference_);
    blur_.run(grid_.u());

    queue_.begin_stage("code");
    coder.code_positions(grid_.u(), depth);
    if (wanted.sparse) {
        if (!sparse_depth_())
            sparse_depth_ = queue_.allocate(size_t{shape_.width} * shape_.height * sizeof(cl_ushort));
        coder.code_places(sparse_.places(), sparse_depth_);
    }
    if (wanted.confidence)
        sparse_.run_confidence(focus_);
}

} // namespace dff
