/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/reference_image.h"
#include "engine/sparse_depth.h"

namespace dff {

/* Fills the unknown pixels of a sparse depth map: (4)-(8) of Oliva-García 2022, solved in bilateral space. */
class BilateralGrid {
public:
    struct Parameters {
        unsigned sigma_xy = 16;    /* pixels a cell */
        unsigned sigma_luma = 16;  /* DN a cell */
        unsigned sigma_chroma = 0; /* DN a cell; 0: cells do not part by chroma */
        float lambda = 0.1f;       /* weight of smoothness (4) */
        unsigned iterations = 25;  /* of the conjugate gradient */
    };

    /* Throws EngineError (TooLarge) if the grid would not fit the device. */
    BilateralGrid(CommandQueue &queue, const StackShape &shape, const Parameters &parameters);

    void run(const SparseDepth &sparse, const ReferenceImage &reference);

    /* float[height][width]: plane positions; NAN everywhere if nothing is known of any pixel. */
    const cl::Buffer &u() const { return u_; }

private:
    void choose_size();
    void build_kernels();
    void allocate();
    void splat(const SparseDepth &sparse, const ReferenceImage &reference);
    void bistochastise();
    void start_solver();
    void iterate();
    void sum_products(const cl::Buffer &a, const cl::Buffer &b);

    CommandQueue &queue_;
    StackShape shape_;
    Parameters parameters_;
    cl_int columns_, rows_, first_, cells_;
    cl_int4 stride_, sigma_;
    size_t all_cells_;
    cl::Kernel splat_, start_normalisation_, normalise_, smoothness_, partial_sums_, partial_products_,
        mean_target_, start_solution_, start_residual_, apply_system_, first_residual_, step_length_,
        next_residual_, advance_, next_direction_, slice_;
    cl::Buffer mass_, weight_, target_, n_, next_n_, smooth_, diagonal_, solution_, residual_, scaled_,
        direction_, product_, parts_, more_parts_, scalars_, u_;
};

} // namespace dff
