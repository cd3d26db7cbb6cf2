/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/focus_volume.h"
#include "engine/low_filter.h"
#include "engine/small_planes.h"

namespace dff {

/* What it costs a cell to lie in a plane: see kernels/cost_volume.cl. */
class CostVolume {
public:
    CostVolume(CommandQueue &queue, const LowShape &low, const NoiseEstimate &noise);

    /* Smooths the fine focus volume along z in place. */
    void run(const FocusVolume &focus, const SmallPlanes &small, const NoiseEstimate &noise);

    const cl::Buffer &fine() const { return fine_; } /* low pictures [z]: C0 */
    const cl::Buffer &cost() const { return cost_; } /* low pictures [z]: C */

    /* float: the largest S0 of any cell, DN. */
    const cl::Buffer &evidence() const { return evidence_; }

private:
    void run_fine(const FocusVolume &focus, const NoiseEstimate &noise);
    void run_coarse(const SmallPlanes &small, const NoiseEstimate &noise);
    void quantile(const cl::Buffer &picture, const cl::Buffer &result, cl_float share);

    CommandQueue &queue_;
    LowShape low_;
    LowFilter blur_, box_;
    cl::Kernel evidence_kernel_, quantile_, largest_, fine_cost_, coarse_focus_, add_coarse_cost_;
    cl::Buffer top_, range_, coarse_top_, coarse_range_, median_top_, median_range_, median_coarse_range_,
        evidence_;
    cl::Buffer fine_, cost_, blurred_, between_, coarse_;
};

} // namespace dff
