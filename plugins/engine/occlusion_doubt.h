/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/semi_global_matching.h"

namespace dff {

/* Doubt of what borders on something farther: see kernels/occlusion_doubt.cl. */
class OcclusionDoubt {
public:
    OcclusionDoubt(CommandQueue &queue, const LowShape &low);

    /* Lowers matching.confidence() in place. `cost`: what was matched. */
    void run(const SemiGlobalMatching &matching, const cl::Buffer &cost, const NoiseEstimate &noise,
             float blur_step);

private:
    const cl::Buffer &spread(const SemiGlobalMatching &matching, cl::Buffer *pictures, int cells,
                             float slope);

    CommandQueue &queue_;
    LowShape low_;
    cl::Kernel begin_far_, spread_far_, doubt_;
    cl::Buffer near_by_[2], cone_[2];
};

} // namespace dff
