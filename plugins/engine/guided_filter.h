/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/low_shape.h"
#include "engine/noise_estimate.h"

namespace dff {

/* Colour guided filter of a cost volume: see kernels/guided_filter.cl. Its window is wider in noise. */
class GuidedFilter {
public:
    GuidedFilter(CommandQueue &queue, const LowShape &low);

    /* Of device memory, beside pictures. */
    static uint64_t scratch_bytes(const LowShape &low);

    /* The sides of cost and guide must be mirrored. */
    void run(const cl::Buffer &cost, const cl::Buffer &guide, const NoiseEstimate &noise);

    /* Lets cells count less that are nearer by their filtered cost than by `nearer`, GuideImage's. */
    void doubt(const cl::Buffer &nearer, const NoiseEstimate &noise);

    const cl::Buffer &filtered() const { return filtered_; } /* low pictures short [z] */

private:
    CommandQueue &queue_;
    LowShape low_;
    cl::Kernel guide_system_, filter_costs_, doubt_nearer_;
    cl::Buffer system_, scratch_, filtered_;
};

} // namespace dff
