/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/sub_plane.h"

#include <cmath>

namespace dff {

namespace {

constexpr float least_blur = 1.6f; /* pixels between planes, or else every other one is compared */

} // namespace

SubPlane::SubPlane(CommandQueue &queue, const LowShape &low)
    : queue_(queue), low_(low), least_(low.allocate(queue, 1)), placed_(low.allocate(queue, 1)),
      floor_(queue.allocate(sizeof(cl_float)))
{
    find_least_ = Program(queue.device(), "blur_step").kernel("find_least");
    quantile_ = Program(queue.device(), "cost_volume").kernel("quantile");
    const Program program(queue.device(), "sub_plane");
    refine_ = program.kernel("refine");
    even_out_ = program.kernel("even_out");
}

void SubPlane::run(const cl::Buffer &u, const FocusVolume &focus, const FocusPyramid &pyramid,
                   const NoiseEstimate &noise, float blur_step)
{
    if (low_.planes < 3)
        return;
    /* The scale of the stack itself has a volume at this resolution; coarser ones have their own. */
    const cl::Buffer *volume = &focus.volume();
    LowShape shape = low_;
    float nearest = std::abs(std::log2(blur_step / 2.0f));
    for (const FocusPyramid::Level &level : pyramid.levels()) {
        const float distance = std::abs(std::log2(blur_step / 2.0f / static_cast<float>(level.shape.scale)));
        if (distance >= nearest)
            continue;
        nearest = distance;
        volume = &level.focus;
        shape = level.shape;
    }
    const cl_int apart = blur_step < least_blur && low_.planes >= 5 ? 2 : 1;
    queue_.begin_stage("sub-plane");
    queue_.run(find_least_, shape.rows(), *volume, least_, shape.width, shape.stride, shape.planes);
    queue_.run(quantile_, {1}, least_, floor_, 0.1f, 1.0f, shape.width, shape.height, shape.stride);
    queue_.run(refine_, low_.rows(), *volume, floor_, noise.noise(), u, placed_, shape.scale / low_.scale,
               apart, low_.width, low_.stride, low_.planes, shape.height, shape.stride);
    queue_.run(even_out_, low_.rows(), placed_, u, low_.width, low_.stride);
}

} // namespace dff
