/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/guided_filter.h"

namespace dff {

namespace {

/* A work-item of filter_costs() keeps more rows than one of guide_system(), of which there are fewer. */
size_t scratch_rows(const LowShape &low)
{
    return low.strips() * static_cast<size_t>(low.planes) * (4 + 4 * 8);
}

} // namespace

GuidedFilter::GuidedFilter(CommandQueue &queue, const LowShape &low)
    : queue_(queue), low_(low), system_(low.allocate(queue, 9)),
      scratch_(low.allocate_rows(queue, scratch_rows(low), sizeof(cl_float))),
      filtered_(low.allocate_shorts(queue, low.planes))
{
    const Program program(queue.device(), "guided_filter");
    guide_system_ = program.kernel("guide_system");
    filter_costs_ = program.kernel("filter_costs");
    doubt_nearer_ = program.kernel("doubt_nearer");
}

uint64_t GuidedFilter::scratch_bytes(const LowShape &low)
{
    return scratch_rows(low) * static_cast<uint64_t>(low.stride) * sizeof(cl_float);
}

void GuidedFilter::run(const cl::Buffer &cost, const cl::Buffer &guide, const NoiseEstimate &noise)
{
    queue_.begin_stage("guided-filter");
    queue_.run(guide_system_, low_.strips_of(1), guide, noise.noise(), system_, scratch_, low_.width,
               low_.height, low_.stride, low_.strip);
    queue_.run(filter_costs_, low_.strips_of(low_.planes), cost, guide, system_, noise.noise(), filtered_,
               scratch_, low_.width, low_.height, low_.stride, low_.strip);
}

void GuidedFilter::doubt(const cl::Buffer &nearer, const NoiseEstimate &noise)
{
    queue_.begin_stage("doubt");
    queue_.run(doubt_nearer_, low_.rows(), filtered_, nearer, noise.noise(), low_.width, low_.stride,
               low_.planes);
}

} // namespace dff
