/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/noise_floor.h"

#include <algorithm>
#include <cmath>

namespace dff {

namespace {

constexpr double looked_at = 20'000; /* cells */

} // namespace

NoiseFloor::NoiseFloor(CommandQueue &queue, const LowShape &low)
    : queue_(queue), low_(low), curve_(queue.allocate(5 * sizeof(cl_float))),
      evened_(low.allocate_shorts(queue, low.planes))
{
    const Program program(queue.device(), "noise_floor");
    find_curve_ = program.kernel("find_curve");
    even_noise_ = program.kernel("even_noise");
}

const cl::Buffer &NoiseFloor::run(const FocusVolume &focus, const SmallPlanes &small,
                                  const NoiseEstimate &noise)
{
    queue_.begin_stage("noise-floor");
    const double cells = static_cast<double>(low_.width) * low_.height * low_.planes;
    const auto step = static_cast<cl_int>(std::max(std::lround(std::sqrt(cells / looked_at)), 1L));
    queue_.run(find_curve_, {1}, focus.volume(), small.colours(), curve_, low_.width, low_.height,
               low_.stride, low_.planes, step);
    queue_.run(even_noise_, low_.rows(), focus.volume(), small.colours(), curve_, noise.noise(), evened_,
               low_.width, low_.stride, low_.planes);
    return evened_;
}

} // namespace dff
