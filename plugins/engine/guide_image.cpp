/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/guide_image.h"

namespace dff {

GuideImage::GuideImage(CommandQueue &queue, const LowShape &low)
    : queue_(queue), low_(low), median_(low.allocate(queue, 1)), nearer_(low.allocate(queue, 1)),
      noisy_(low.allocate_shorts(queue, 3)), guide_(low.allocate(queue, 3))
{
    const Program program(queue.device(), "guide_image");
    median_5x5_ = program.kernel("median_5x5");
    blend_planes_ = program.kernel("blend_planes");
    denoise_ = program.kernel("denoise");
}

void GuideImage::run(const CostVolume &cost, const SmallPlanes &small, const NoiseEstimate &noise)
{
    queue_.begin_stage("guide");
    queue_.run(median_5x5_, low_.rows(), cost.first_guess(), median_, low_.width, low_.stride);
    blend(median_, small, noise, true);
    queue_.run(denoise_, low_.rows(), noisy_, noise.noise(), guide_, low_.width, low_.stride, low_.scale);
}

void GuideImage::run_at(const cl::Buffer &u, const SmallPlanes &small, const NoiseEstimate &noise)
{
    queue_.begin_stage("guide-again");
    blend(u, small, noise, false);
}

void GuideImage::blend(const cl::Buffer &u, const SmallPlanes &small, const NoiseEstimate &noise,
                       bool is_filtered)
{
    queue_.run(blend_planes_, low_.rows(), small.colours(), u, noise.noise(), nearer_, guide_, noisy_,
               cl_int{is_filtered}, low_.width, low_.stride, low_.planes);
}

} // namespace dff
