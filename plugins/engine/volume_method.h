/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/blur_step.h"
#include "engine/depth_method.h"
#include "engine/depth_parameters.h"
#include "engine/guided_filter.h"
#include "engine/joint_upsampling.h"
#include "engine/noise_floor.h"
#include "engine/occlusion_doubt.h"
#include "engine/seen_through.h"
#include "engine/sub_plane.h"
#include "engine/uncertainty.h"

namespace dff {

/* Spreads the evidence of focus at low resolution, decides once, and upsamples by colour. Every stage's
 * formula stands in its kernel file; README.md says what was tried. */
class VolumeMethod : public DepthMethod {
public:
    VolumeMethod(CommandQueue &queue, const StackShape &shape, const DepthParameters &parameters);
    ~VolumeMethod() override;

    /* Bytes of device memory it takes beside the stack, with all maps wanted. */
    static uint64_t memory(const StackShape &shape, const DepthParameters &parameters);

    /* Waits for the device once, to learn the blur step that the stages after it go by. */
    void run(const StackBuffer &stack, DepthCoder &coder, const Wanted &wanted,
             const cl::Buffer &depth) override;

    const cl::Buffer &sparse() const override;
    const cl::Buffer &confidence() const override;
    const cl::Buffer &motion() const override { return entropy_->moved(); }
    float blur_step() const override { return blur_.step; }
    const cl::Buffer *uncertainty() const override;

private:
    struct Stages;

    void measure(const StackBuffer &stack);
    void run_motion(const StackBuffer &stack);

    CommandQueue &queue_;
    StackShape shape_;
    DepthParameters parameters_;
    std::unique_ptr<Stages> stages_; /* at one scale */
    BlurStep::Blur blur_;            /* of the last stack */
    std::unique_ptr<Luma> luma_;
    std::unique_ptr<ZEntropy> entropy_;
};

} // namespace dff
