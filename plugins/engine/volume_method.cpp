/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/volume_method.h"

namespace dff {

VolumeMethod::VolumeMethod(CommandQueue &queue, const StackShape &shape, const DepthParameters &parameters)
    : queue_(queue), shape_(shape), parameters_(parameters), low_(shape, parameters.scale),
      noise_(queue, shape, low_.scale), small_(queue, shape, low_), focus_(queue, shape, low_),
      cost_(queue, low_), guide_(queue, low_), filter_(queue, low_), matching_(queue, low_),
      fill_(queue, low_), upsampling_(queue, shape, low_)
{
}

uint64_t VolumeMethod::memory(const StackShape &shape, const DepthParameters &parameters)
{
    const LowShape low(shape, parameters.scale);
    const uint64_t row = uint64_t{sizeof(cl_short)} * static_cast<uint64_t>(low.stride);
    const uint64_t planes = shape.planes;
    const uint64_t pictures = 11 * planes + 5 + 2 * 28; /* of shorts; one of floats is two */
    const uint64_t pixels = uint64_t{shape.width} * shape.height;
    const bool is_interleaved_or_16 =
        shape.components().front().channels > 1 || shape.components().front().sample_bytes > 1;
    const uint64_t motion = pixels * (is_interleaved_or_16 ? planes + 1 : 1);
    return low.height * row * pictures + CostVolume::scratch_bytes(low) + GuidedFilter::scratch_bytes(low) +
           FocusVolume::scratch_bytes(shape, low) + pixels * (2 * sizeof(cl_ushort) + 1) + motion;
}

void VolumeMethod::run(const StackBuffer &stack, DepthCoder &coder, const Wanted &wanted,
                       const cl::Buffer &depth)
{
    noise_.run(stack);
    small_.run(stack);
    focus_.run(stack, noise_);
    cost_.run(focus_, small_, noise_);
    guide_.run(cost_, small_, noise_);
    filter_.run(cost_.cost(), guide_.guide(), noise_);
    filter_.doubt(guide_.nearer(), noise_);
    matching_.run(filter_.filtered(), guide_.guide(), noise_);
    fill_.run(matching_);
    guide_.run_at(matching_.u(), small_, noise_);
    upsampling_.run(matching_.u(), guide_, cost_, noise_, stack, coder, depth);

    const bool mask_motion = wanted.sparse && parameters_.motion_mask;
    if (wanted.motion || mask_motion)
        run_motion(stack);
    if (wanted.confidence || wanted.sparse)
        upsampling_.run_confidence(matching_, cost_);
    if (wanted.sparse)
        upsampling_.run_sparse(depth, fill_, mask_motion ? entropy_.get() : nullptr);
}

void VolumeMethod::run_motion(const StackBuffer &stack)
{
    if (!entropy_) {
        luma_ = std::make_unique<Luma>(queue_, shape_);
        entropy_ = std::make_unique<ZEntropy>(queue_, shape_, parameters_.entropy_bits);
    }
    luma_->run(stack);
    entropy_->run(*luma_);
}

} // namespace dff
