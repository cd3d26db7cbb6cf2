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

    /* The sides of the guide must be mirrored. */
    void run(const cl::Buffer &cost, const cl::Buffer &guide, const NoiseEstimate &noise);

    const cl::Buffer &u() const { return u_; }                   /* low picture */
    const cl::Buffer &confidence() const { return confidence_; } /* low picture: mean_z C, 0 to 1 */

    /* E to the cell above, and to the cell at the left in a transposed picture. */
    const cl::Buffer &edges() const { return edges_; }
    const cl::Buffer &edges_along_rows() const { return edges_along_rows_; }

    /* Exchanges rows and columns of low pictures. */
    void transpose(const cl::Buffer &volume, const LowShape &from, const cl::Buffer &transposed,
                   size_t pictures);

private:
    void follow(const LowShape &low, const cl::Buffer &cost, const cl::Buffer &edges,
                const NoiseEstimate &noise, const cl::Buffer &total, cl_int dx);

    CommandQueue &queue_;
    LowShape low_, transposed_;
    cl::Kernel edges_above_, mirror_sides_, follow_, transpose_, decide_;
    cl::Buffer edges_, guide_transposed_, edges_along_rows_, total_, cost_transposed_, total_transposed_,
        row_total_, u_, confidence_;
};

} // namespace dff
