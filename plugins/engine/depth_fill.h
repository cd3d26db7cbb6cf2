/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/cost_volume.h"
#include "engine/semi_global_matching.h"

namespace dff {

/* Depth where the confidence is low, from around: see kernels/depth_fill.cl. */
class DepthFill {
public:
    DepthFill(CommandQueue &queue, const LowShape &low);

    /* Changes matching.u() in place and mirrors its sides. t: of the noise, in which it reaches farther. */
    void run(const SemiGlobalMatching &matching, float t, float blur_step);

    /* Low pictures [2], of the last run: what it filled with times the evidence around, and that evidence,
     * the smoothed square of the confidence. */
    const cl::Buffer &solved() const { return pair_; }

    /* float: the 90th percentile of the confidence. */
    const cl::Buffer &high_confidence() const { return high_confidence_; }

private:
    CommandQueue &queue_;
    LowShape low_;
    cl::Kernel weigh_, smooth_columns_, smooth_rows_, fill_, quantile_;
    cl::Buffer pair_, scratch_, high_confidence_;
};

} // namespace dff
