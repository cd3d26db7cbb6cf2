/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/depth_reach.h"

#include <algorithm>
#include <cmath>

namespace dff {

namespace {

constexpr float wideness = 1.5f; /* the slope beside that of blur */
constexpr float spare = 0.35f;   /* of a block's slope */
constexpr float depth_range = 65534.0f;
constexpr float farthest = 64.0f; /* blocks looked at */

} // namespace

DepthReach::DepthReach(CommandQueue &queue, const StackShape &shape)
    : queue_(queue), shape_(shape), blocks_(shape, 0),
      limited_(queue.allocate(size_t{shape.width} * shape.height * sizeof(cl_ushort)))
{
    const Program program(queue.device(), "depth_reach", "-DBLOCK=" + std::to_string(blocks_.scale));
    nearest_of_blocks_ = program.kernel("nearest_of_blocks");
    spread_nearest_ = program.kernel("spread_nearest");
    limit_depth_ = program.kernel("limit_depth");
    for (cl::Buffer &picture : nearest_)
        picture = blocks_.allocate_shorts(queue, 1);
}

const cl::Buffer &DepthReach::run(const cl::Buffer &depth, size_t stride, float blur_step)
{
    const auto depth_stride = static_cast<cl_int>(stride);
    const float slope = std::min(wideness * 2.0f * static_cast<float>(blocks_.scale) / blur_step *
                                     depth_range / static_cast<float>(shape_.planes - 1),
                                 depth_range);
    const int steps = static_cast<int>(std::min(std::ceil(depth_range / slope), farthest));

    queue_.begin_stage("depth-reach");
    queue_.run(nearest_of_blocks_, blocks_.rows(), depth, depth_stride, nearest_[0], blocks_.width,
               blocks_.stride);
    for (int i = 0; i < steps; i++)
        queue_.run(spread_nearest_, blocks_.rows(), nearest_[i % 2], nearest_[1 - i % 2],
                   static_cast<cl_ushort>(slope), cl_int{i % 2 == 0}, blocks_.width, blocks_.stride);
    queue_.run(limit_depth_, {1, shape_.height}, depth, depth_stride, nearest_[steps % 2],
               static_cast<cl_ushort>(spare * slope), limited_, static_cast<cl_int>(shape_.width),
               blocks_.width, blocks_.height, blocks_.stride);
    return limited_;
}

} // namespace dff
