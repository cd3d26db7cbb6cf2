/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/depth_fill.h"

#include <algorithm>
#include <cmath>

namespace dff {

namespace {

constexpr int iterations = 2;
constexpr double usual_step = 8.0; /* pixels a plane; above, what is doubted is wider */

/* Of Min et al. 2014: falls by four each time, all together lambda. */
cl_float lambda_of(int iteration, float t, float blur_step)
{
    const double lambda = 100.0 * std::max(1.0 + 5.0 * t, std::pow(blur_step / usual_step, 2));
    return static_cast<cl_float>(1.5 * lambda * std::pow(4.0, iterations - 1 - iteration) /
                                 (std::pow(4.0, iterations) - 1.0));
}

} // namespace

DepthFill::DepthFill(CommandQueue &queue, const LowShape &low)
    : queue_(queue), low_(low), pair_(low.allocate(queue, 2)), scratch_(low.allocate(queue, 1)),
      high_confidence_(queue.allocate(sizeof(cl_float)))
{
    const Program program(queue.device(), "depth_fill");
    weigh_ = program.kernel("weigh");
    smooth_columns_ = program.kernel("smooth_columns");
    smooth_rows_ = program.kernel("smooth_rows");
    fill_ = program.kernel("fill");
    quantile_ = Program(queue.device(), "cost_volume").kernel("quantile");
}

void DepthFill::run(const SemiGlobalMatching &matching, float t, float blur_step)
{
    queue_.begin_stage("fill");
    queue_.run(quantile_, {1}, matching.confidence(), high_confidence_, 0.9f, 255.0f, low_.width, low_.height,
               low_.stride);
    queue_.run(weigh_, low_.rows(), matching.u(), matching.confidence(), pair_, low_.width, low_.stride);
    for (int i = 0; i < iterations; i++) {
        queue_.run(smooth_columns_, {1, static_cast<size_t>(low_.width + 15) / 16}, pair_, matching.edges(),
                   scratch_, lambda_of(i, t, blur_step), low_.height, low_.stride);
        queue_.run(smooth_rows_, {1, static_cast<size_t>(low_.height + 7) / 8}, pair_, matching.edges(),
                   scratch_, lambda_of(i, t, blur_step), low_.width, low_.height, low_.stride);
    }
    queue_.run(fill_, low_.rows(), pair_, matching.confidence(), high_confidence_, matching.u(), low_.width,
               low_.stride);
}

} // namespace dff
