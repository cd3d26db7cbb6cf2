/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/focus_leak.h"

#include <algorithm>
#include <cmath>

namespace dff {

namespace {

constexpr int farthest = 24; /* cells looked at */

float share_of(float radius, float blur_step)
{
    return 0.9f * std::clamp(blur_step - FocusLeak::least_step, 0.0f, 1.0f) / std::pow(radius, 0.4f);
}

} // namespace

FocusLeak::FocusLeak(CommandQueue &queue, const LowShape &low)
    : queue_(queue), low_(low), leak_(low.allocate_shorts(queue, low.planes))
{
    const Program program(queue.device(), "focus_leak");
    begin_ = program.kernel("begin_leak");
    spread_ = program.kernel("spread_leak");
    gather_ = program.kernel("gather_leak");
    take_ = program.kernel("take_leak");
    for (cl::Buffer &volume : reached_)
        volume = low.allocate_shorts(queue, low.planes);
}

void FocusLeak::run(const cl::Buffer &focus, const cl::Buffer &medians, const NoiseEstimate &noise,
                    float blur_step)
{
    queue_.begin_stage("focus-leak");
    queue_.run(begin_, low_.rows_of_planes(), focus, medians, reached_[0], leak_, low_.width, low_.stride);
    int cells = 0;
    for (cl_int distance = 1; distance < low_.planes; distance++) {
        const float radius = static_cast<float>(distance) * blur_step / 2.0f / static_cast<float>(low_.scale);
        const int reach = static_cast<int>(std::lround(radius + 1.0f));
        if (radius < 1.0f)
            continue;
        if (reach > farthest)
            break;
        for (; cells < reach; cells++)
            queue_.run(spread_, low_.rows_of_planes(), reached_[cells % 2], reached_[1 - cells % 2],
                       cl_int{cells % 2 == 0}, low_.width, low_.stride);
        queue_.run(gather_, low_.rows_of_planes(), reached_[cells % 2], noise.noise(), leak_, distance,
                   share_of(radius, blur_step), low_.width, low_.stride);
    }
    queue_.run(take_, low_.rows_of_planes(), leak_, focus, low_.width, low_.stride);
}

} // namespace dff
