/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/semi_global_matching.h"

namespace dff {

SemiGlobalMatching::SemiGlobalMatching(CommandQueue &queue, const LowShape &low)
    : queue_(queue), low_(low), transposed_(low.transposed()), edges_(low.allocate(queue, 3)),
      guide_transposed_(transposed_.allocate(queue, 3)), edges_along_rows_(transposed_.allocate(queue, 3)),
      total_(low.allocate(queue, low.planes)), cost_transposed_(transposed_.allocate(queue, low.planes)),
      total_transposed_(transposed_.allocate(queue, low.planes)), row_total_(low.allocate(queue, low.planes)),
      u_(low.allocate(queue, 1)), confidence_(low.allocate(queue, 1))
{
    const Program program(queue.device(), "semi_global_matching", "-DPLANES=" + std::to_string(low.planes));
    edges_above_ = program.kernel("edges_above");
    follow_ = program.kernel("follow");
    transpose_ = program.kernel("transpose");
    decide_ = program.kernel("decide");
}

void SemiGlobalMatching::run(const cl::Buffer &cost, const cl::Buffer &guide, const NoiseEstimate &noise)
{
    queue_.begin_stage("matching");
    queue_.run(edges_above_, low_.rows(), guide, edges_, low_.width, low_.stride);
    for (const cl_int dx : {0, 1, -1})
        follow(low_, cost, edges_, noise, total_, dx);

    transpose(guide, low_, guide_transposed_, 3);
    transpose(cost, low_, cost_transposed_, low_.planes);
    queue_.run(edges_above_, transposed_.rows(), guide_transposed_, edges_along_rows_, transposed_.width,
               transposed_.stride);
    follow(transposed_, cost_transposed_, edges_along_rows_, noise, total_transposed_, 0);
    transpose(total_transposed_, transposed_, row_total_, low_.planes);

    queue_.run(decide_, low_.rows(), total_, row_total_, cost, u_, confidence_, low_.width, low_.stride);
}

/* Both ways; the paths with dx = 0 start the total. */
void SemiGlobalMatching::follow(const LowShape &low, const cl::Buffer &cost, const cl::Buffer &edges,
                                const NoiseEstimate &noise, const cl::Buffer &total, cl_int dx)
{
    const auto blocks = static_cast<size_t>(low.width + (dx == 0 ? 0 : low.height) + 7) / 8 + 1;
    for (const cl_int up : {0, 1})
        queue_.run(follow_, {1, dx == 0 ? static_cast<size_t>(low.width + 7) / 8 : blocks}, cost, edges,
                   noise.noise(), total, dx, up, cl_int{dx == 0 && up == 0}, low.width, low.height,
                   low.stride);
}

void SemiGlobalMatching::transpose(const cl::Buffer &volume, const LowShape &from,
                                   const cl::Buffer &transposed, size_t pictures)
{
    queue_.run(transpose_, {1, static_cast<size_t>(from.height + 7) / 8, pictures}, volume, transposed,
               from.width, from.height, from.stride, from.transposed().stride);
}

} // namespace dff
