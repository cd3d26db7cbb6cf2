/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/depth_coder.h"
#include "engine/depth_fill.h"
#include "engine/guide_image.h"
#include "engine/z_entropy.h"

namespace dff {

/* Maps at full resolution from the low ones: see kernels/joint_upsampling.cl. */
class JointUpsampling {
public:
    JointUpsampling(CommandQueue &queue, const StackShape &shape, const LowShape &low);

    /* `guide` at the low `u`; depth becomes ushort[height][width], 0 without evidence. */
    void run(const cl::Buffer &low_u, const GuideImage &guide, const CostVolume &cost,
             const NoiseEstimate &noise, const StackBuffer &stack, const DepthCoder &coder,
             const cl::Buffer &depth);
    void run_confidence(const SemiGlobalMatching &matching, const CostVolume &cost);

    /* After both, from their `depth`; leaves pixels that moved out, where `motion` is given. */
    void run_sparse(const cl::Buffer &depth, const DepthFill &fill, const ZEntropy *motion);

    const cl::Buffer &confidence() const { return confidence_; } /* uchar[height][width] */
    const cl::Buffer &sparse() const { return sparse_; }         /* ushort[height][width], 0 where unknown */

private:
    CommandQueue &queue_;
    StackShape shape_;
    LowShape low_;
    cl_int4 channels_;
    cl::Kernel upsample_, upsample_confidence_, keep_confident_;
    cl::Buffer confidence_, sparse_;
};

} // namespace dff
