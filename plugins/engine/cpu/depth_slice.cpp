/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/cpu/depth_slice.h"

#include "engine/gaussian_blur.h"

#include <cmath>
#include <numeric>

namespace dff {

namespace {

/* TILE_WIDTH and TILE_HEIGHT of slice_depth.cl */
constexpr size_t tile_width = 960, tile_height = 64;

/* In parts of 65536: the centre's, then both at a distance of 1, 2... */
std::vector<cl_ushort> weights_of(const std::vector<float> &taps)
{
    const size_t radius = taps.size() / 2;
    std::vector<cl_ushort> weights(radius + 1);
    for (size_t i = 1; i <= radius; i++)
        weights[i] = static_cast<cl_ushort>(std::lround(2.0 * 65536.0 * taps[radius + i]));
    weights[0] =
        static_cast<cl_ushort>(65536 - std::accumulate(weights.begin() + 1, weights.end(), cl_int{0}));
    return weights;
}

} // namespace

DepthSlice::DepthSlice(CommandQueue &queue, const StackShape &shape, const LumaGrid &grid)
    : queue_(queue), shape_(shape)
{
    const std::vector<cl_ushort> weights = weights_of(GaussianBlur::taps_for(grid.parameters().sigma_xy));
    kernel_ = Program(queue.device(), "slice_depth",
                      grid.build_options() + " -DRADIUS=" + std::to_string(weights.size() - 1))
                  .kernel("slice_depth");
    const size_t bytes = weights.size() * sizeof(cl_ushort);
    weights_ = queue.allocate(bytes);
    queue.commands().enqueueWriteBuffer(weights_, CL_TRUE, 0, bytes, weights.data());
}

void DepthSlice::run(const LumaGrid &grid, const cl::Buffer &luma, const DepthCoder &coder,
                     const cl::Buffer &depth)
{
    const auto width = static_cast<cl_int>(shape_.width);
    queue_.begin_stage("slice");
    queue_.run_groups(
        kernel_,
        {(shape_.width + tile_width - 1) / tile_width, (shape_.height + tile_height - 1) / tile_height},
        grid.solution(), luma, weights_, coder.codes(), depth, width, static_cast<cl_int>(shape_.height),
        width, static_cast<cl_int>(shape_.planes), static_cast<cl_int>(coder.is_linear()));
}

} // namespace dff
