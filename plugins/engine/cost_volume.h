/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/focus_leak.h"
#include "engine/small_planes.h"

namespace dff {

/* What it costs a cell to lie in a plane: see kernels/cost_volume.cl. */
class CostVolume {
public:
    CostVolume(CommandQueue &queue, const LowShape &low);

    /* Of device memory, beside pictures. */
    static uint64_t scratch_bytes(const LowShape &low);

    /* In this order. focus: low pictures short [z]; blur_step: pixels a plane. C is C0 after the first. */
    void run_fine(const cl::Buffer &focus, const NoiseEstimate &noise);
    void run_coarse(const SmallPlanes &small, const NoiseEstimate &noise, float blur_step);
    void run_guess(const NoiseEstimate &noise);

    const cl::Buffer &top() const { return top_; }            /* low picture float: T0, 1/FOCUS_ONE DN */
    const cl::Buffer &median_top() const { return medians_; } /* float: med T0, DN; and more */

    /* Low pictures short, their sides mirrored. */
    const cl::Buffer &cost() const { return cost_; }         /* [z]: C */
    const cl::Buffer &first_guess() const { return guess_; } /* u0 */

    /* F1 and F2 before they are smoothed along z. */
    const cl::Buffer &coarse_focus() const { return coarse_; }
    const cl::Buffer &wide_focus() const { return wide_; }

    /* float: the largest S0 of any cell, DN. */
    const cl::Buffer &evidence() const { return largest_range_; }

    /* Cells between the values of F1 that F2 is the mean of: blur reaches as far as a part of the picture's
     * width. */
    static cl_int guess_spacing(cl_int width);

private:
    void summarise_coarse(const NoiseEstimate &noise);

    CommandQueue &queue_;
    LowShape low_;
    cl::Kernel find_evidence_, summarise_, fine_cost_, coarse_focus_, add_coarse_cost_, widen_focus_,
        first_guess_;
    cl::Buffer top_, range_, coarse_top_, coarse_range_, medians_, coarse_medians_, largest_range_,
        largest_coarse_range_, wide_top_, wide_range_;
    FocusLeak leak_;
    cl::Buffer cost_, guess_, coarse_, wide_, coarse_scratch_;
};

} // namespace dff
