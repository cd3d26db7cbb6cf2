/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/cost_volume.h"

namespace dff {

CostVolume::CostVolume(CommandQueue &queue, const LowShape &low, const NoiseEstimate &noise)
    : queue_(queue), low_(low), blur_(queue, low, LowFilter::gaussian(4, 1.0f), noise.noise()),
      box_(queue, low, LowFilter::box(3), noise.noise())
{
    const Program program(queue.device(), "cost_volume");
    evidence_kernel_ = program.kernel("evidence");
    quantile_ = program.kernel("quantile");
    largest_ = program.kernel("largest");
    fine_cost_ = program.kernel("fine_cost");
    coarse_focus_ = program.kernel("coarse_focus");
    add_coarse_cost_ = program.kernel("add_coarse_cost");

    for (cl::Buffer *picture : {&top_, &range_, &coarse_top_, &coarse_range_})
        *picture = low.allocate(queue, 1);
    for (cl::Buffer *number : {&median_top_, &median_range_, &median_coarse_range_, &evidence_})
        *number = queue.allocate(sizeof(cl_float));
    for (cl::Buffer *volume : {&fine_, &cost_, &coarse_})
        *volume = low.allocate(queue, low.planes);
    for (cl::Buffer *colours : {&blurred_, &between_})
        *colours = low.allocate(queue, 3 * size_t(low.planes));
}

void CostVolume::run(const FocusVolume &focus, const SmallPlanes &small, const NoiseEstimate &noise)
{
    run_fine(focus, noise);
    run_coarse(small, noise);
}

void CostVolume::run_fine(const FocusVolume &focus, const NoiseEstimate &noise)
{
    queue_.begin_stage("cost");
    queue_.run(evidence_kernel_, low_.rows(), focus.volume(), noise.noise(), top_, range_, cl_int{0},
               low_.width, low_.stride, low_.planes);
    quantile(top_, median_top_, 0.5f);
    quantile(range_, median_range_, 0.5f);
    queue_.run(largest_, {1}, range_, evidence_, low_.width, low_.height, low_.stride);
    queue_.run(fine_cost_, low_.rows_of_planes(), focus.volume(), top_, median_top_, fine_, low_.width,
               low_.stride);
}

void CostVolume::run_coarse(const SmallPlanes &small, const NoiseEstimate &noise)
{
    const size_t colours = 3 * size_t(low_.planes);
    queue_.begin_stage("coarse-cost");
    blur_.run(small.colours(), between_, blurred_, colours);
    blur_.mirror_sides(blurred_, colours);
    queue_.run(coarse_focus_, low_.rows_of_planes(), blurred_, noise.noise(), coarse_, low_.width,
               low_.stride);
    box_.run(coarse_, between_, coarse_, low_.planes);
    queue_.run(evidence_kernel_, low_.rows(), coarse_, noise.noise(), coarse_top_, coarse_range_, cl_int{1},
               low_.width, low_.stride, low_.planes);
    quantile(coarse_range_, median_coarse_range_, 0.5f);
    queue_.run(add_coarse_cost_, low_.rows_of_planes(), fine_, coarse_, coarse_top_, range_, coarse_range_,
               median_range_, median_coarse_range_, noise.noise(), cost_, low_.width, low_.stride);
}

void CostVolume::quantile(const cl::Buffer &picture, const cl::Buffer &result, cl_float share)
{
    queue_.run(quantile_, {1}, picture, result, share, cl_float{1}, low_.width, low_.height, low_.stride);
}

} // namespace dff
