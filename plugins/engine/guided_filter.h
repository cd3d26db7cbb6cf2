/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/low_filter.h"
#include "engine/noise_estimate.h"

namespace dff {

/* Colour guided filter of a cost volume: see kernels/guided_filter.cl. Its window is wider in noise. */
class GuidedFilter {
public:
    GuidedFilter(CommandQueue &queue, const LowShape &low);

    /* The sides of the guide must be mirrored; those of `cost` are by this. */
    void run(const cl::Buffer &cost, const cl::Buffer &guide, const NoiseEstimate &noise);

    const cl::Buffer &filtered() const { return filtered_; } /* low pictures [z] */

private:
    CommandQueue &queue_;
    LowShape low_;
    LowFilter sides_;
    cl::Kernel guide_system_, fit_, apply_;
    cl::Buffer system_, coefficients_, scratch_, filtered_;
};

} // namespace dff
