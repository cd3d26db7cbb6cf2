/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/guided_filter.h"

#include <algorithm>

namespace dff {

namespace {

constexpr cl_int strip = 16; /* rows a work-item */

} // namespace

GuidedFilter::GuidedFilter(CommandQueue &queue, const LowShape &low)
    : queue_(queue), low_(low), sides_(queue, low, LowFilter::box(0)), system_(low.allocate(queue, 9)),
      coefficients_(low.allocate(queue, 4 * size_t(low.planes))), filtered_(low.allocate(queue, low.planes))
{
    const Program program(queue.device(), "guided_filter", "-DSTRIP=" + std::to_string(strip));
    guide_system_ = program.kernel("guide_system");
    fit_ = program.kernel("fit");
    apply_ = program.kernel("apply");
    const size_t strips = (low.height + strip - 1) / strip;
    const size_t scratch_rows = std::max<size_t>(9 * size_t(low.height), 4 * strips * low.planes);
    scratch_ = queue.allocate(scratch_rows * low.stride * sizeof(cl_float));
}

void GuidedFilter::run(const cl::Buffer &cost, const cl::Buffer &guide, const NoiseEstimate &noise)
{
    const cl::NDRange strips(1, static_cast<size_t>((low_.height + strip - 1) / strip),
                             static_cast<size_t>(low_.planes));
    queue_.begin_stage("guided-filter");
    sides_.mirror_sides(cost, low_.planes);
    queue_.run(guide_system_, low_.rows(), guide, noise.noise(), system_, scratch_, low_.width, low_.stride);
    queue_.run(fit_, strips, cost, guide, system_, noise.noise(), coefficients_, scratch_, low_.width,
               low_.height, low_.stride);
    sides_.mirror_sides(coefficients_, 4 * size_t(low_.planes));
    queue_.run(apply_, strips, coefficients_, guide, noise.noise(), filtered_, scratch_, low_.width,
               low_.height, low_.stride);
}

} // namespace dff
