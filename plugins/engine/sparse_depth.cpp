/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/sparse_depth.h"

namespace dff {

SparseDepth::SparseDepth(CommandQueue &queue, const StackShape &shape, float tolerance)
    : queue_(queue), shape_(shape), tolerance_(tolerance)
{
    const Program program(queue.device(), "sparse_depth");
    sum_rows_ = program.kernel("sum_rows");
    mean_of_rows_ = program.kernel("mean_of_rows");
    row_maximum_kernel_ = program.kernel("row_maximum");
    select_ridges_ = program.kernel("select_ridges");
    focus_confidence_ = program.kernel("focus_confidence");

    const size_t pixels = size_t{shape.width} * shape.height;
    row_sums_ = queue.allocate(shape.height * sizeof(cl_float));
    total_mean_ = queue.allocate(sizeof(cl_float));
    row_maximum_ = queue.allocate(pixels * sizeof(cl_float));
    sparse_ = queue.allocate(pixels);
}

void SparseDepth::run(const FocusMeasure &focus, const ZEntropy *motion)
{
    const auto width = static_cast<cl_int>(shape_.width), height = static_cast<cl_int>(shape_.height);
    const cl::NDRange pixels(shape_.width, shape_.height);
    /* A kernel argument must be some buffer; it is not read when nothing is known of motion. */
    const cl::Buffer &moved = motion ? motion->moved() : focus.place();

    queue_.begin_stage("sparse-depth");
    queue_.run(sum_rows_, {shape_.height}, focus.mean(), row_sums_, width, height);
    queue_.run(mean_of_rows_, {1}, row_sums_, total_mean_, width, height);
    queue_.run(row_maximum_kernel_, pixels, focus.peak(), row_maximum_, width);
    queue_.run(select_ridges_, pixels, focus.peak(), focus.place(), focus.mean(), row_maximum_, total_mean_,
               moved, sparse_, width, height, tolerance_, static_cast<cl_int>(motion != nullptr));
}

void SparseDepth::run_confidence(const FocusMeasure &focus)
{
    if (!confidence_())
        confidence_ = queue_.allocate(size_t{shape_.width} * shape_.height);
    queue_.begin_stage("confidence");
    queue_.run(focus_confidence_, {shape_.width, shape_.height}, focus.peak(), focus.mean(), confidence_,
               static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.planes));
}

} // namespace dff
