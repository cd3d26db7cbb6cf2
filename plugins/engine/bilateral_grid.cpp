/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/bilateral_grid.h"

#include "engine/engine_error.h"

#include <limits>

namespace dff {

namespace {

constexpr size_t parts = 256;               /* PARTS of bilateral_grid.cl */
constexpr unsigned bistochastisations = 10; /* enough for 1 % (Barron and Poole 2016) */
constexpr size_t scalars_size = 4 * sizeof(cl_float);

uint64_t cells_for(uint64_t size, uint64_t sigma)
{
    return (size - 1) / sigma + 1 + 2; /* an empty cell at both ends */
}

} // namespace

BilateralGrid::BilateralGrid(CommandQueue &queue, const StackShape &shape, const Parameters &parameters)
    : queue_(queue), shape_(shape), parameters_(parameters)
{
    choose_size();
    build_kernels();
    allocate();
}

void BilateralGrid::choose_size()
{
    const uint64_t sigma_xy = parameters_.sigma_xy, chroma = parameters_.sigma_chroma;
    const uint64_t luma_cells = cells_for(256, parameters_.sigma_luma);
    const uint64_t chroma_cells = chroma ? cells_for(256, chroma) : 1;
    const uint64_t column_cells = luma_cells * chroma_cells * chroma_cells;
    const uint64_t row_cells = column_cells * cells_for(shape_.width, sigma_xy);
    const uint64_t all_cells = row_cells * cells_for(shape_.height, sigma_xy);
    if (all_cells > std::numeric_limits<cl_int>::max() ||
        all_cells * sizeof(cl_float) > queue_.device().largest_allocation())
        throw EngineError(EngineError::Kind::TooLarge,
                          "The bilateral grid would have " + std::to_string(all_cells) +
                              " cells, too many for this device: raise sigma-xy, sigma-luma or sigma-chroma");

    columns_ = static_cast<cl_int>(cells_for(shape_.width, sigma_xy) - 2);
    rows_ = static_cast<cl_int>(cells_for(shape_.height, sigma_xy) - 2);
    stride_ = {{static_cast<cl_int>(row_cells), static_cast<cl_int>(column_cells),
                static_cast<cl_int>(luma_cells * chroma_cells), static_cast<cl_int>(luma_cells)}};
    sigma_ = {{static_cast<cl_int>(sigma_xy), static_cast<cl_int>(parameters_.sigma_luma),
               static_cast<cl_int>(chroma), 0}};
    first_ = stride_.s[0];
    cells_ = rows_ * stride_.s[0];
    all_cells_ = all_cells;
}

void BilateralGrid::build_kernels()
{
    const Program program(queue_.device(), "bilateral_grid",
                          parameters_.sigma_chroma ? "-DDIMENSIONS=5" : "-DDIMENSIONS=3");
    splat_ = program.kernel("splat");
    start_normalisation_ = program.kernel("start_normalisation");
    normalise_ = program.kernel("normalise");
    smoothness_ = program.kernel("smoothness");
    partial_sums_ = program.kernel("partial_sums");
    partial_products_ = program.kernel("partial_products");
    mean_target_ = program.kernel("mean_target");
    start_solution_ = program.kernel("start_solution");
    start_residual_ = program.kernel("start_residual");
    apply_system_ = program.kernel("apply_system");
    first_residual_ = program.kernel("first_residual");
    step_length_ = program.kernel("step_length");
    next_residual_ = program.kernel("next_residual");
    advance_ = program.kernel("advance");
    next_direction_ = program.kernel("next_direction");
    slice_ = program.kernel("slice");
}

/* The border cells of vectors whose neighbours are read must be 0 for ever: no kernel writes them. */
void BilateralGrid::allocate()
{
    for (cl::Buffer *vector : {&mass_, &weight_, &target_, &n_, &next_n_, &smooth_, &diagonal_, &solution_,
                               &residual_, &scaled_, &direction_, &product_}) {
        *vector = queue_.allocate(all_cells_ * sizeof(cl_float));
        queue_.commands().enqueueFillBuffer(*vector, cl_float{0}, 0, all_cells_ * sizeof(cl_float));
    }
    parts_ = queue_.allocate(parts * sizeof(cl_float));
    more_parts_ = queue_.allocate(parts * sizeof(cl_float));
    scalars_ = queue_.allocate(scalars_size);
    u_ = queue_.allocate(size_t{shape_.width} * shape_.height * sizeof(cl_float));
}

void BilateralGrid::run(const SparseDepth &sparse, const ReferenceImage &reference)
{
    queue_.begin_stage("splat");
    splat(sparse, reference);
    bistochastise();
    queue_.begin_stage("solve");
    start_solver();
    for (unsigned i = 0; i < parameters_.iterations; i++)
        iterate();
    queue_.begin_stage("slice");
    queue_.run(slice_, {shape_.width, shape_.height}, solution_, reference.y(), reference.u(), reference.v(),
               u_, static_cast<cl_int>(shape_.width), stride_, sigma_);
}

void BilateralGrid::splat(const SparseDepth &sparse, const ReferenceImage &reference)
{
    for (const cl::Buffer *vector : {&mass_, &weight_, &target_})
        queue_.commands().enqueueFillBuffer(*vector, cl_float{0}, 0, all_cells_ * sizeof(cl_float));
    queue_.run(splat_, {static_cast<size_t>(columns_), static_cast<size_t>(rows_)}, sparse.places(),
               reference.y(), reference.u(), reference.v(), mass_, weight_, target_,
               static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.height), columns_, stride_,
               sigma_);
}

void BilateralGrid::bistochastise()
{
    const cl::NDRange cells(static_cast<size_t>(cells_));
    queue_.run(start_normalisation_, cells, mass_, n_, first_, cells_);
    for (unsigned i = 0; i < bistochastisations; i++) {
        queue_.run(normalise_, cells, mass_, n_, next_n_, first_, cells_, stride_);
        std::swap(n_, next_n_);
    }
    queue_.run(smoothness_, cells, n_, smooth_, first_, cells_, stride_);
}

void BilateralGrid::start_solver()
{
    const cl::NDRange cells(static_cast<size_t>(cells_));
    queue_.run(partial_sums_, {parts}, target_, parts_, first_, cells_);
    queue_.run(partial_sums_, {parts}, weight_, more_parts_, first_, cells_);
    queue_.run(mean_target_, {1}, parts_, more_parts_, scalars_);
    queue_.run(start_solution_, cells, n_, smooth_, weight_, target_, scalars_, solution_, diagonal_, first_,
               cells_, parameters_.lambda);
    queue_.run(start_residual_, cells, n_, smooth_, weight_, target_, scalars_, solution_, diagonal_,
               residual_, scaled_, direction_, first_, cells_, stride_, parameters_.lambda);
    sum_products(residual_, scaled_);
    queue_.run(first_residual_, {1}, parts_, scalars_);
}

/* One step of the preconditioned conjugate gradient. */
void BilateralGrid::iterate()
{
    const cl::NDRange cells(static_cast<size_t>(cells_));
    queue_.run(apply_system_, cells, n_, smooth_, weight_, direction_, product_, first_, cells_, stride_,
               parameters_.lambda);
    sum_products(direction_, product_);
    queue_.run(step_length_, {1}, parts_, scalars_);
    queue_.run(advance_, cells, scalars_, direction_, product_, diagonal_, solution_, residual_, scaled_,
               first_, cells_);
    sum_products(residual_, scaled_);
    queue_.run(next_residual_, {1}, parts_, scalars_);
    queue_.run(next_direction_, cells, scalars_, scaled_, direction_, first_, cells_);
}

void BilateralGrid::sum_products(const cl::Buffer &a, const cl::Buffer &b)
{
    queue_.run(partial_products_, {parts}, a, b, parts_, first_, cells_);
}

} // namespace dff
