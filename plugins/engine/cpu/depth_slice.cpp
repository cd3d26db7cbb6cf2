/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/cpu/depth_slice.h"

#include "engine/gaussian_blur.h"

namespace dff {

namespace {

/* TILE_WIDTH and TILE_HEIGHT of slice_depth.cl */
constexpr size_t tile_width = 256, tile_height = 64;

} // namespace

DepthSlice::DepthSlice(CommandQueue &queue, const StackShape &shape, const LumaGrid &grid)
    : queue_(queue), shape_(shape)
{
    const std::vector<float> taps = GaussianBlur::taps_for(grid.parameters().sigma_xy);
    const size_t radius = taps.size() / 2;
    kernel_ =
        Program(queue.device(), "slice_depth", grid.build_options() + " -DRADIUS=" + std::to_string(radius))
            .kernel("slice_depth");
    taps_ = queue.allocate((radius + 1) * sizeof(cl_float));
    queue.commands().enqueueWriteBuffer(taps_, CL_TRUE, 0, (radius + 1) * sizeof(cl_float),
                                        taps.data() + radius);
}

void DepthSlice::run(const LumaGrid &grid, const cl::Buffer &luma, const DepthCoder &coder,
                     const cl::Buffer &depth)
{
    const auto width = static_cast<cl_int>(shape_.width);
    queue_.begin_stage("slice");
    queue_.run_groups(
        kernel_,
        {(shape_.width + tile_width - 1) / tile_width, (shape_.height + tile_height - 1) / tile_height},
        grid.solution(), luma, taps_, coder.codes(), depth, width, static_cast<cl_int>(shape_.height), width,
        static_cast<cl_int>(shape_.planes), static_cast<cl_int>(coder.is_linear()));
}

} // namespace dff
