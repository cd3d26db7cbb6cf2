/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/cpu/luma_grid.h"

#include "engine/engine_error.h"

#include <algorithm>
#include <limits>

namespace dff {

namespace {

constexpr unsigned bistochastisations = 10; /* enough for 1 % (Barron and Poole 2016) */
constexpr float residual_tolerance = 1e-5f; /* of the right-hand side's norm */
constexpr size_t lanes = 16;

/* Step of luma_grid.cl. */
struct Step {
    cl_float squared_residual, alpha;
    cl_int done;
};

constexpr size_t parts_of(size_t size, size_t part)
{
    return (size + part - 1) / part;
}

} // namespace

LumaGrid::LumaGrid(CommandQueue &queue, uint32_t width, uint32_t height,
                   const BilateralGrid::Parameters &parameters)
    : queue_(queue), width_(width), height_(height), parameters_(parameters),
      columns_(parts_of(width, parameters.sigma_xy)), rows_(parts_of(height, parameters.sigma_xy)),
      column_cells_(parts_of(256, parameters.sigma_luma) + 1),
      row_cells_(parts_of((columns_ + 1) * column_cells_ + std::max(column_cells_, lanes), lanes) * lanes)
{
    const size_t cells = (rows_ + 2) * row_cells_;
    if (cells > std::numeric_limits<cl_int>::max() ||
        cells * sizeof(cl_float) > queue.device().largest_allocation())
        throw EngineError(EngineError::Kind::TooLarge,
                          "The bilateral grid would have " + std::to_string(cells) +
                              " cells, too many for this device: raise sigma-xy or sigma-luma");
    build_kernels();
    allocate();
}

std::string LumaGrid::build_options() const
{
    return "-DCOLUMN=" + std::to_string(column_cells_) + " -DROW=" + std::to_string(row_cells_) +
           " -DCOLUMNS=" + std::to_string(columns_) + " -DROWS=" + std::to_string(rows_) +
           " -DSIGMA_XY=" + std::to_string(parameters_.sigma_xy) +
           " -DSIGMA_LUMA=" + std::to_string(parameters_.sigma_luma);
}

void LumaGrid::build_kernels()
{
    const Program program(queue_.device(), "luma_grid", build_options());
    splat_ = program.kernel("splat_rows");
    normalise_ = program.kernel("normalise_rows");
    scale_ = program.kernel("scale_rows");
    spread_rows_ = program.kernel("spread_rows");
    spread_columns_ = program.kernel("spread_columns");
    start_ = program.kernel("start_rows");
    start_residuals_ = program.kernel("start_residuals");
    choose_start_ = program.kernel("choose_start");
    residual_product_ = program.kernel("residual_product");
    advance_ = program.kernel("advance_rows");
    finish_ = program.kernel("finish_rows");
}

/* The border cells and what fills the last vector of a sum, which no kernel writes, must be 0. */
void LumaGrid::allocate()
{
    const size_t bytes = (rows_ + 2) * row_cells_ * sizeof(cl_float);
    for (cl::Buffer *cells :
         {&mass_, &weight_, &target_, &n_, &next_n_, &coefficient_, &scale_of_cell_, &right_, &x_, &residual_,
          &product_of_residual_, &direction_, &product_, &solution_}) {
        *cells = queue_.allocate(bytes);
        queue_.commands().enqueueFillBuffer(*cells, cl_float{0}, 0, bytes);
    }
    const size_t sums_bytes = parts_of(rows_, lanes) * lanes * sizeof(cl_float2);
    for (cl::Buffer *sums : {&row_sums_, &row_norms_, &row_dots_}) {
        *sums = queue_.allocate(sums_bytes);
        queue_.commands().enqueueFillBuffer(*sums, cl_float{0}, 0, sums_bytes);
    }
    residual_norm_ = queue_.allocate(sizeof(cl_float));
    steps_ = queue_.allocate((parameters_.iterations + 1) * sizeof(Step));
    queue_.commands().enqueueFillBuffer(steps_, cl_uchar{0}, 0, (parameters_.iterations + 1) * sizeof(Step));
}

void LumaGrid::run(const cl::Buffer &sparse, const cl::Buffer &luma)
{
    queue_.begin_stage("splat");
    splat(sparse, luma);
    queue_.begin_stage("solve");
    start();
    iterate();
}

void LumaGrid::splat(const cl::Buffer &sparse, const cl::Buffer &luma)
{
    queue_.run_groups(splat_, {rows_}, sparse, luma, mass_, weight_, target_, n_, row_sums_,
                      static_cast<cl_int>(width_), static_cast<cl_int>(height_));
    for (unsigned i = 0; i < bistochastisations; i++) {
        queue_.run_groups(normalise_, {rows_}, mass_, n_, next_n_);
        std::swap(n_, next_n_);
    }
    queue_.run_groups(scale_, {rows_}, n_, weight_, target_, row_sums_, coefficient_, scale_of_cell_, right_,
                      row_norms_, parameters_.lambda);
}

/* Borrows vectors of the conjugate gradient that are not in use yet. */
void LumaGrid::start()
{
    const cl::Buffer &spread_target = residual_, &spread_weight = product_of_residual_;
    queue_.run_groups(spread_rows_, {rows_}, target_, weight_, spread_target, spread_weight);
    queue_.run_groups(spread_columns_, {row_cells_ / lanes}, spread_target, spread_weight);
    queue_.run_groups(start_, {rows_}, spread_target, spread_weight, row_sums_, solution_, scale_of_cell_, x_,
                      direction_);
    queue_.run_groups(start_residuals_, {rows_}, coefficient_, right_, x_, direction_, residual_, product_,
                      row_dots_);
    queue_.run_groups(choose_start_, {rows_}, row_dots_, x_, residual_, direction_, product_);
}

void LumaGrid::iterate()
{
    for (unsigned i = 0; i < parameters_.iterations; i++) {
        const auto step = static_cast<cl_int>(i);
        queue_.run_groups(residual_product_, {rows_}, coefficient_, residual_, product_of_residual_,
                          row_dots_, steps_, step);
        queue_.run_groups(advance_, {rows_}, row_dots_, row_norms_, steps_, step, residual_,
                          product_of_residual_, direction_, product_, x_, residual_tolerance);
    }
    queue_.run_groups(finish_, {rows_}, x_, scale_of_cell_, row_sums_, solution_, row_norms_, steps_,
                      static_cast<cl_int>(parameters_.iterations), residual_norm_);
}

} // namespace dff
