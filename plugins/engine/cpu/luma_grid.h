/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/bilateral_grid.h"

namespace dff {

/* BilateralGrid for the CPU, without chroma: fills the unknown pixels of a sparse depth map, (4)-(8) of
 * Oliva-García 2022. Starts from the better of a smoothed splat and the solution before. */
class LumaGrid {
public:
    /* sigma_chroma must be 0. Throws EngineError (TooLarge) if the grid would not fit the device. */
    LumaGrid(CommandQueue &queue, uint32_t width, uint32_t height,
             const BilateralGrid::Parameters &parameters);

    /* Solves for sparse planes and the reference's luma, uchar[height][width] each. */
    void run(const cl::Buffer &sparse, const cl::Buffer &luma);

    /* Plane position of each cell; NAN everywhere if nothing is known of any pixel. */
    const cl::Buffer &solution() const { return solution_; }

    /* float: the residual the solver left, in parts of the right-hand side. */
    const cl::Buffer &residual_norm() const { return residual_norm_; }

    /* Options for kernels that read the solution: those of luma_grid.cl. */
    std::string build_options() const;

    const BilateralGrid::Parameters &parameters() const { return parameters_; }

private:
    void build_kernels();
    void allocate();
    void splat(const cl::Buffer &sparse, const cl::Buffer &luma);
    void start();
    void iterate();

    CommandQueue &queue_;
    uint32_t width_, height_;
    BilateralGrid::Parameters parameters_;
    size_t columns_, rows_, column_cells_, row_cells_;
    cl::Kernel splat_, normalise_, scale_, spread_rows_, spread_columns_, start_, start_residuals_,
        choose_start_, residual_product_, advance_, finish_;
    cl::Buffer mass_, weight_, target_, n_, next_n_, coefficient_, scale_of_cell_, right_, x_, residual_,
        product_of_residual_, direction_, product_, solution_;
    cl::Buffer row_sums_, row_norms_, row_dots_, steps_, residual_norm_;
};

} // namespace dff
