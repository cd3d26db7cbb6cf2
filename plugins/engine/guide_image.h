/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/cost_volume.h"

namespace dff {

/* A small picture that is sharp everywhere, by a depth: see kernels/guide_image.cl. */
class GuideImage {
public:
    GuideImage(CommandQueue &queue, const LowShape &low);

    /* At a first guess, denoised. */
    void run(const CostVolume &cost, const SmallPlanes &small, const NoiseEstimate &noise);

    /* At the depth `u`, whose sides are mirrored; not denoised. */
    void run_at(const cl::Buffer &u, const SmallPlanes &small, const NoiseEstimate &noise);

    /* Their sides are mirrored. */
    const cl::Buffer &guide() const { return guide_; }   /* low pictures [R, G, B] */
    const cl::Buffer &nearer() const { return nearer_; } /* the least u around each cell */

private:
    void blend(const cl::Buffer &u, const SmallPlanes &small, const NoiseEstimate &noise, bool is_filtered);

    CommandQueue &queue_;
    LowShape low_;
    cl::Kernel median_5x5_, blend_planes_, denoise_;
    cl::Buffer median_, nearer_, noisy_, guide_;
};

} // namespace dff
