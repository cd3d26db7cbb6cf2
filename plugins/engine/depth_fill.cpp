/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/depth_fill.h"

#include <algorithm>
#include <cmath>

namespace dff {

namespace {

constexpr cl_int above = 0, left = 3; /* among the edges */
constexpr int iterations = 2;
constexpr double lambda = 100.0;

/* Of Min et al. 2014: falls by four each time, all together lambda. */
cl_float lambda_of(int iteration)
{
    return static_cast<cl_float>(1.5 * lambda * std::pow(4.0, iterations - 1 - iteration) /
                                 (std::pow(4.0, iterations) - 1.0));
}

} // namespace

DepthFill::DepthFill(CommandQueue &queue, const LowShape &low)
    : queue_(queue), low_(low), transposed_(low.transposed()), pair_(low.allocate(queue, 2)),
      pair_transposed_(transposed_.allocate(queue, 2)), edges_transposed_(transposed_.allocate(queue, 4)),
      high_confidence_(queue.allocate(sizeof(cl_float)))
{
    const size_t cells = std::max(low.height * low.stride, transposed_.height * transposed_.stride);
    scratch_ = queue.allocate(cells * sizeof(cl_float));
    const Program program(queue.device(), "depth_fill");
    weigh_ = program.kernel("weigh");
    smooth_columns_ = program.kernel("smooth_columns");
    fill_ = program.kernel("fill");
    quantile_ = Program(queue.device(), "cost_volume").kernel("quantile");
}

void DepthFill::run(SemiGlobalMatching &matching)
{
    queue_.begin_stage("fill");
    queue_.run(quantile_, {1}, matching.confidence(), high_confidence_, 0.9f, 255.0f, low_.width, low_.height,
               low_.stride);
    queue_.run(weigh_, low_.rows(), matching.u(), matching.confidence(), pair_, low_.width, low_.stride);
    matching.transpose(matching.edges(), low_, edges_transposed_, 4);
    for (int i = 0; i < iterations; i++) {
        smooth(pair_, low_, matching.edges(), above, lambda_of(i));
        matching.transpose(pair_, low_, pair_transposed_, 2);
        smooth(pair_transposed_, transposed_, edges_transposed_, left, lambda_of(i));
        matching.transpose(pair_transposed_, transposed_, pair_, 2);
    }
    queue_.run(fill_, low_.rows(), pair_, matching.confidence(), high_confidence_, matching.u(), low_.width,
               low_.stride);
}

void DepthFill::smooth(const cl::Buffer &pair, const LowShape &low, const cl::Buffer &edges, cl_int direction,
                       cl_float lambda)
{
    queue_.run(smooth_columns_, {1, static_cast<size_t>(low.width + 7) / 8}, pair, edges, direction, scratch_,
               lambda, low.height, low.stride);
}

} // namespace dff
