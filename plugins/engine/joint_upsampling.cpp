/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/joint_upsampling.h"

namespace dff {

JointUpsampling::JointUpsampling(CommandQueue &queue, const StackShape &shape, const LowShape &low)
    : queue_(queue), shape_(shape), low_(low), channels_(colour_channels(shape.format))
{
    const Program program(queue.device(), "joint_upsampling",
                          colour_options(shape.format) + " -DSCALE=" + std::to_string(low.scale));
    upsample_ = program.kernel("upsample_depth");
    upsample_confidence_ = program.kernel("upsample_confidence");
    keep_confident_ = program.kernel("keep_confident");
}

void JointUpsampling::run(const cl::Buffer &low_u, const GuideImage &guide, const CostVolume &cost,
                          const NoiseEstimate &noise, const StackBuffer &stack, const DepthCoder &coder,
                          const cl::Buffer &depth)
{
    queue_.begin_stage("upsample");
    queue_.run(upsample_, {1, static_cast<size_t>(low_.height) + 2}, low_u, guide.nearer(), guide.guide(),
               noise.noise(), cost.evidence(), stack.bytes(), stack.layout(), channels_, coder.codes(),
               cl_int{coder.is_linear()}, depth, static_cast<cl_int>(shape_.planes),
               static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.height), low_.height,
               low_.stride);
}

void JointUpsampling::run_confidence(const SemiGlobalMatching &matching, const CostVolume &cost)
{
    if (!confidence_())
        confidence_ = queue_.allocate(size_t{shape_.width} * shape_.height);
    queue_.begin_stage("confidence");
    queue_.run(upsample_confidence_, {1, shape_.height}, matching.confidence(), cost.evidence(), confidence_,
               static_cast<cl_int>(shape_.width), low_.height, low_.stride);
}

void JointUpsampling::run_sparse(const cl::Buffer &depth, const DepthFill &fill, const ZEntropy *motion)
{
    if (!sparse_())
        sparse_ = queue_.allocate(size_t{shape_.width} * shape_.height * sizeof(cl_ushort));
    queue_.begin_stage("sparse-depth");
    queue_.run(keep_confident_, {1, shape_.height}, depth, confidence_,
               motion ? motion->moved() : confidence_, cl_int{motion != nullptr}, fill.high_confidence(),
               sparse_, static_cast<cl_int>(shape_.width));
}

} // namespace dff
