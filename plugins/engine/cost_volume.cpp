/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/cost_volume.h"

#include "engine/opencl/program.h"

#include <algorithm>

namespace dff {

namespace {

/* Rows of scratch, as coarse_focus() counts them. */
size_t coarse_rows(const LowShape &low)
{
    return low.strips() * static_cast<size_t>(low.planes) * 2 * static_cast<size_t>(low.strip + 10);
}

} // namespace

cl_int CostVolume::guess_spacing(cl_int width)
{
    return std::clamp((width + 27) / 55 - 3, 1, 8);
}

CostVolume::CostVolume(CommandQueue &queue, const LowShape &low)
    : queue_(queue), low_(low), medians_(queue.allocate(2 * sizeof(cl_float))),
      coarse_medians_(queue.allocate(2 * sizeof(cl_float))), largest_range_(queue.allocate(sizeof(cl_float))),
      largest_coarse_range_(queue.allocate(sizeof(cl_float))), leak_(queue, low),
      cost_(low.allocate_shorts(queue, low.planes)), guess_(low.allocate_shorts(queue, 1)),
      coarse_(low.allocate_shorts(queue, low.planes)), wide_(low.allocate_shorts(queue, low.planes)),
      coarse_scratch_(low.allocate_rows(queue, coarse_rows(low), sizeof(cl_ushort)))
{
    const Program program(queue.device(), "cost_volume");
    find_evidence_ = program.kernel("evidence");
    summarise_ = program.kernel("summarise");
    fine_cost_ = program.kernel("fine_cost");
    coarse_focus_ = program.kernel("coarse_focus");
    add_coarse_cost_ = program.kernel("add_coarse_cost");
    widen_focus_ = program.kernel("widen_focus");
    first_guess_ = program.kernel("first_guess");
    for (cl::Buffer *picture : {&top_, &range_, &coarse_top_, &coarse_range_, &wide_top_, &wide_range_})
        *picture = low.allocate(queue, 1);
}

uint64_t CostVolume::scratch_bytes(const LowShape &low)
{
    return static_cast<uint64_t>(low.stride) * coarse_rows(low) * sizeof(cl_ushort);
}

void CostVolume::run_fine(const cl::Buffer &focus, const NoiseEstimate &noise)
{
    queue_.begin_stage("cost");
    queue_.run(find_evidence_, low_.rows(), focus, noise.noise(), top_, range_, low_.width, low_.stride,
               low_.planes);
    queue_.run(summarise_, {1, 2}, top_, range_, medians_, largest_range_, low_.width, low_.height,
               low_.stride);
    queue_.run(fine_cost_, low_.rows_of_planes(), focus, top_, medians_, noise.noise(), cost_, low_.width,
               low_.stride);
}

void CostVolume::run_coarse(const SmallPlanes &small, const NoiseEstimate &noise, float blur_step)
{
    queue_.begin_stage("coarse-cost");
    queue_.run(coarse_focus_, low_.strips_of(low_.planes), small.colours(), coarse_, coarse_scratch_,
               low_.width, low_.height, low_.stride, low_.strip);
    summarise_coarse(noise);
    if (FocusLeak::is_needed(blur_step)) {
        leak_.run(coarse_, coarse_medians_, noise, blur_step);
        queue_.begin_stage("coarse-cost");
        summarise_coarse(noise);
    }
    queue_.run(add_coarse_cost_, low_.rows_of_planes(), coarse_, coarse_top_, range_, coarse_range_, medians_,
               coarse_medians_, noise.noise(), cost_, low_.width, low_.stride);
}

void CostVolume::summarise_coarse(const NoiseEstimate &noise)
{
    queue_.run(find_evidence_, low_.rows(), coarse_, noise.noise(), coarse_top_, coarse_range_, low_.width,
               low_.stride, low_.planes);
    queue_.run(summarise_, {1, 2}, coarse_top_, coarse_range_, coarse_medians_, largest_coarse_range_,
               low_.width, low_.height, low_.stride);
}

void CostVolume::run_guess(const NoiseEstimate &noise)
{
    queue_.begin_stage("first-guess");
    queue_.run(widen_focus_, low_.rows_of_planes(), coarse_, wide_, guess_spacing(low_.width), low_.width,
               low_.stride);
    queue_.run(find_evidence_, low_.rows(), wide_, noise.noise(), wide_top_, wide_range_, low_.width,
               low_.stride, low_.planes);
    queue_.run(first_guess_, low_.rows(), cost_, wide_, wide_top_, range_, wide_range_, medians_,
               coarse_medians_, noise.noise(), guess_, low_.width, low_.stride, low_.planes);
}

} // namespace dff
