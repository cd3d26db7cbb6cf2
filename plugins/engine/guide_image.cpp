/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/guide_image.h"

namespace dff {

GuideImage::GuideImage(CommandQueue &queue, const LowShape &low)
    : queue_(queue), low_(low), box_(queue, low, LowFilter::box(2)), boxed_(low.allocate(queue, low.planes)),
      between_(low.allocate(queue, low.planes)), u_(low.allocate(queue, 1)), median_(low.allocate(queue, 1)),
      nearer_(low.allocate(queue, 1)), blended_(low.allocate(queue, 3)), guide_(low.allocate(queue, 3))
{
    const Program program(queue.device(), "guide_image", "-DSCALE=" + std::to_string(low.scale));
    cheapest_plane_ = program.kernel("cheapest_plane");
    median_5x5_ = program.kernel("median_5x5");
    nearest_3x3_ = program.kernel("nearest_3x3");
    blend_planes_ = program.kernel("blend_planes");
    denoise_ = program.kernel("denoise");
}

void GuideImage::run(const CostVolume &cost, const SmallPlanes &small, const NoiseEstimate &noise)
{
    queue_.begin_stage("guide");
    box_.run(cost.fine(), between_, boxed_, low_.planes);
    queue_.run(cheapest_plane_, low_.rows(), boxed_, u_, low_.width, low_.stride, low_.planes);
    box_.mirror_sides(u_, 1);
    queue_.run(median_5x5_, low_.rows(), u_, median_, low_.width, low_.stride);
    box_.mirror_sides(median_, 1);
    queue_.run(nearest_3x3_, low_.rows(), median_, nearer_, low_.width, low_.stride);
    queue_.run(blend_planes_, low_.rows(), small.colours(), nearer_, noise.noise(), blended_, low_.width,
               low_.stride, low_.planes);
    box_.mirror_sides(blended_, 3);
    queue_.run(denoise_, low_.rows(), blended_, noise.noise(), guide_, low_.width, low_.stride);
    box_.mirror_sides(guide_, 3);
}

void GuideImage::run_at(const cl::Buffer &u, const SmallPlanes &small, const NoiseEstimate &noise)
{
    queue_.begin_stage("guide-again");
    box_.mirror_sides(u, 1);
    queue_.run(nearest_3x3_, low_.rows(), u, nearer_, low_.width, low_.stride);
    box_.mirror_sides(nearer_, 1);
    queue_.run(blend_planes_, low_.rows(), small.colours(), nearer_, noise.noise(), guide_, low_.width,
               low_.stride, low_.planes);
    box_.mirror_sides(guide_, 3);
}

} // namespace dff
