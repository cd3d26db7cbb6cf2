/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/uncertainty.h"

namespace dff {

Uncertainty::Uncertainty(CommandQueue &queue, const StackShape &shape, const LowShape &low)
    : queue_(queue), shape_(shape), low_(low), matched_(low.allocate(queue, 1)),
      decided_(low.allocate(queue, 1)), deviation_(low.allocate(queue, 1)),
      map_(queue.allocate(size_t{shape.width} * shape.height * sizeof(cl_ushort)))
{
    const Program program(queue.device(), "uncertainty", "-DSCALE=" + std::to_string(low.scale));
    low_deviation_ = program.kernel("low_deviation");
    upsample_deviation_ = program.kernel("upsample_deviation");
}

void Uncertainty::remember_matched(const cl::Buffer &u)
{
    queue_.commands().enqueueCopyBuffer(u, matched_, 0, 0, matched_.getInfo<CL_MEM_SIZE>());
}

void Uncertainty::remember_decided(const cl::Buffer &u)
{
    queue_.commands().enqueueCopyBuffer(u, decided_, 0, 0, decided_.getInfo<CL_MEM_SIZE>());
}

void Uncertainty::run(const cl::Buffer &u, const DepthFill &fill, const cl::Buffer &filtered,
                      const NoiseEstimate &noise, DepthCoder &coder, const cl::Buffer &depth)
{
    queue_.begin_stage("uncertainty");
    queue_.run(low_deviation_, low_.rows(), u, decided_, matched_, fill.solved(), fill.high_confidence(),
               filtered, noise.noise(), deviation_, low_.width, low_.stride, low_.planes);
    queue_.run(upsample_deviation_, {1, shape_.height}, deviation_, depth, coder.slopes(), map_,
               static_cast<cl_int>(shape_.width), low_.height, low_.stride);
}

} // namespace dff
