/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/occlusion_doubt.h"

#include <algorithm>
#include <cmath>

namespace dff {

namespace {

constexpr float far_one = 512.0f;  /* FAR_ONE of the kernels */
constexpr float wideness = 1.25f;  /* the cone's slope beside that of blur */
constexpr int farthest = 64;       /* cells looked at */
constexpr float least_step = 2.5f; /* px: nothing is doubted below */

} // namespace

OcclusionDoubt::OcclusionDoubt(CommandQueue &queue, const LowShape &low) : queue_(queue), low_(low)
{
    const Program program(queue.device(), "occlusion_doubt");
    begin_far_ = program.kernel("begin_far");
    spread_far_ = program.kernel("spread_far");
    doubt_ = program.kernel("doubt_nearer_side");
    for (cl::Buffer *pictures : {near_by_, cone_})
        for (int i = 0; i < 2; i++)
            pictures[i] = low.allocate_shorts(queue, 1);
}

void OcclusionDoubt::run(const SemiGlobalMatching &matching, const cl::Buffer &cost,
                         const NoiseEstimate &noise, float blur_step)
{
    if (blur_step <= least_step)
        return;
    queue_.begin_stage("occlusion-doubt");
    const float cells = blur_step / static_cast<float>(low_.scale);
    const float slope = wideness * 2.0f / cells;
    const int reach = static_cast<int>(std::ceil(static_cast<float>(low_.planes - 1) / slope));
    const cl::Buffer &near_by =
        spread(matching, near_by_, std::max(static_cast<int>(std::lround(cells)), 1), 0.0f);
    const cl::Buffer &cone = spread(matching, cone_, std::min(reach, farthest), slope);
    queue_.run(doubt_, low_.rows(), matching.u(), near_by, cone, cost, noise.noise(), matching.confidence(),
               blur_step, low_.width, low_.stride, low_.planes);
}

const cl::Buffer &OcclusionDoubt::spread(const SemiGlobalMatching &matching, cl::Buffer *pictures, int cells,
                                         float slope)
{
    queue_.run(begin_far_, low_.rows(), matching.u(), pictures[0], low_.width, low_.stride);
    const auto step = static_cast<cl_short>(std::min(std::lround(far_one * slope), 32767L));
    for (int i = 0; i < cells; i++)
        queue_.run(spread_far_, low_.rows(), pictures[i % 2], pictures[1 - i % 2], step, cl_int{i % 2 == 0},
                   low_.width, low_.stride);
    return pictures[cells % 2];
}

} // namespace dff
