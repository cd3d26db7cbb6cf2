/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/noise_estimate.h"

#include "engine/luma.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace dff {

namespace {

constexpr size_t bins = 1024;        /* BINS of noise.cl */
constexpr double looked_at = 8000.0; /* pixels a plane: the median is then good to about 2 % */

} // namespace

NoiseEstimate::NoiseEstimate(CommandQueue &queue, const StackShape &shape, cl_int scale)
    : queue_(queue), shape_(shape), scale_(scale),
      histograms_(queue.allocate(shape.planes * bins * sizeof(cl_uint))),
      sigmas_(queue.allocate(shape.planes * sizeof(cl_float))), noise_(queue.allocate(sizeof(Noise)))
{
    const Program program(queue.device(), "noise", colour_options(shape.format));
    plane_noise_ = program.kernel("plane_noise");
    judge_noise_ = program.kernel("judge_noise");
}

void NoiseEstimate::run(const StackBuffer &stack)
{
    const double pixels = static_cast<double>(shape_.width) * shape_.height;
    const auto step = static_cast<cl_int>(std::max(std::sqrt(pixels / looked_at), 1.0));
    queue_.begin_stage("noise");
    const cl_ulong changed = stack.changed_planes();
    unmeasured_ |= changed;
    if (!stack.noise())
        queue_.run(plane_noise_, {1, shape_.planes}, stack.bytes(), stack.layout(),
                   colour_channels(shape_.format), std::exchange(unmeasured_, 0), histograms_, sigmas_,
                   static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.height), step);
    queue_.run(judge_noise_, {1}, sigmas_, noise_, static_cast<cl_int>(shape_.planes), scale_,
               cl_int{std::popcount(changed) < static_cast<int>(shape_.planes)},
               stack.noise().value_or(-1.0F));
}

} // namespace dff
