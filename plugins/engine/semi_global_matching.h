/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/low_shape.h"
#include "engine/noise_estimate.h"

namespace dff {

/* Decides u from a cost volume: see kernels/semi_global_matching.cl. */
class SemiGlobalMatching {
public:
    SemiGlobalMatching(CommandQueue &queue, const LowShape &low);

    /* `cost`: shorts below 1.5; the sides of the guide must be mirrored. */
    void run(const cl::Buffer &cost, const cl::Buffer &guide, const NoiseEstimate &noise);

    const cl::Buffer &u() const { return u_; }                   /* low picture */
    const cl::Buffer &confidence() const { return confidence_; } /* low picture: mean_z C, 0 to 1 */

    /* Low pictures short: E to the cell above, above left, above right, left. */
    const cl::Buffer &edges() const { return edges_; }

private:
    CommandQueue &queue_;
    LowShape low_;
    cl::Kernel find_edges_, sweep_rows_, follow_rows_, decide_;
    cl::Buffer edges_, total_down_, total_up_, total_along_, scratch_, u_, confidence_;
};

} // namespace dff
