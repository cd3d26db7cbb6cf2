/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/semi_global_matching.h"

namespace dff {

SemiGlobalMatching::SemiGlobalMatching(CommandQueue &queue, const LowShape &low)
    : queue_(queue), low_(low), edges_(low.allocate_shorts(queue, 4)),
      total_down_(low.allocate_shorts(queue, low.planes)), total_up_(low.allocate_shorts(queue, low.planes)),
      total_along_(low.allocate_shorts(queue, low.planes)),
      scratch_(low.allocate_rows(queue, size_t{2} * 6 * (low.planes + 1), sizeof(cl_short))),
      u_(low.allocate(queue, 1)), confidence_(low.allocate(queue, 1))
{
    const Program program(queue.device(), "semi_global_matching", "-DPLANES=" + std::to_string(low.planes));
    find_edges_ = program.kernel("find_edges");
    sweep_rows_ = program.kernel("sweep_rows");
    follow_rows_ = program.kernel("follow_rows");
    decide_ = program.kernel("decide");
}

void SemiGlobalMatching::run(const cl::Buffer &cost, const cl::Buffer &guide, const NoiseEstimate &noise)
{
    queue_.begin_stage("matching");
    queue_.run(find_edges_, low_.rows(), guide, edges_, low_.width, low_.stride);
    queue_.run(sweep_rows_, {1, 2}, cost, edges_, noise.noise(), total_down_, total_up_, scratch_, low_.width,
               low_.height, low_.stride);
    queue_.run(follow_rows_, {1, static_cast<size_t>(low_.height + 15) / 16}, cost, edges_, noise.noise(),
               total_along_, low_.width, low_.height, low_.stride);
    queue_.run(decide_, low_.rows(), total_down_, total_up_, total_along_, cost, u_, confidence_,
               noise.noise(), low_.width, low_.stride);
}

} // namespace dff
