/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/depth_method.h"
#include "engine/depth_parameters.h"
#include "engine/guided_filter.h"
#include "engine/joint_upsampling.h"

namespace dff {

/* Spreads the evidence of focus at low resolution, decides once, and upsamples by colour. Every stage's
 * formula stands in its kernel file; README.md says what was tried. */
class VolumeMethod : public DepthMethod {
public:
    VolumeMethod(CommandQueue &queue, const StackShape &shape, const DepthParameters &parameters);

    /* Bytes of device memory it takes beside the stack, with all maps wanted. */
    static uint64_t memory(const StackShape &shape, const DepthParameters &parameters);

    void run(const StackBuffer &stack, DepthCoder &coder, const Wanted &wanted,
             const cl::Buffer &depth) override;

    const cl::Buffer &sparse() const override { return upsampling_.sparse(); }
    const cl::Buffer &confidence() const override { return upsampling_.confidence(); }
    const cl::Buffer &motion() const override { return entropy_->moved(); }

private:
    void run_motion(const StackBuffer &stack);

    CommandQueue &queue_;
    StackShape shape_;
    DepthParameters parameters_;
    LowShape low_;
    NoiseEstimate noise_;
    SmallPlanes small_;
    FocusVolume focus_;
    CostVolume cost_;
    GuideImage guide_;
    GuidedFilter filter_;
    SemiGlobalMatching matching_;
    DepthFill fill_;
    JointUpsampling upsampling_;
    std::unique_ptr<Luma> luma_;
    std::unique_ptr<ZEntropy> entropy_;
};

} // namespace dff
