/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/volume_method.h"

#include <optional>

namespace dff {

/* All of one scale. */
struct VolumeMethod::Stages {
    Stages(CommandQueue &queue, const StackShape &shape, unsigned scale)
        : low(shape, scale), noise(queue, shape, low.scale), small(queue, shape, low),
          focus(queue, shape, low), pyramid(queue, low), blur_step(queue, pyramid), floor(queue, low),
          cost(queue, low), guide(queue, low), filter(queue, low), matching(queue, low), doubt(queue, low),
          sub_plane(queue, low), fill(queue, low), upsampling(queue, shape, low)
    {
    }

    LowShape low;
    NoiseEstimate noise;
    SmallPlanes small;
    FocusVolume focus;
    FocusPyramid pyramid;
    BlurStep blur_step;
    NoiseFloor floor;
    CostVolume cost;
    GuideImage guide;
    GuidedFilter filter;
    SemiGlobalMatching matching;
    OcclusionDoubt doubt;
    SubPlane sub_plane;
    DepthFill fill;
    JointUpsampling upsampling;
    std::optional<SeenThrough> seen_through; /* once one was preferred */
    std::optional<Uncertainty> uncertainty;  /* once it was wanted */
};

VolumeMethod::VolumeMethod(CommandQueue &queue, const StackShape &shape, const DepthParameters &parameters)
    : queue_(queue), shape_(shape), parameters_(parameters),
      stages_(std::make_unique<Stages>(queue, shape, parameters.scale))
{
}

VolumeMethod::~VolumeMethod() = default;

const cl::Buffer &VolumeMethod::sparse() const
{
    return stages_->upsampling.sparse();
}

const cl::Buffer &VolumeMethod::confidence() const
{
    return stages_->upsampling.confidence();
}

const cl::Buffer *VolumeMethod::uncertainty() const
{
    return stages_->uncertainty ? &stages_->uncertainty->map() : nullptr;
}

uint64_t VolumeMethod::memory(const StackShape &shape, const DepthParameters &parameters)
{
    const LowShape low(shape, parameters.scale);
    const uint64_t row = uint64_t{sizeof(cl_short)} * static_cast<uint64_t>(low.stride);
    const uint64_t planes = shape.planes;
    const uint64_t pictures = 15 * planes + 9 + 2 * 36; /* of shorts; one of floats is two */
    const uint64_t pixels = uint64_t{shape.width} * shape.height;
    const uint64_t luma = is_interleaved(shape.format) ? planes * sample_bytes(shape.format) : 0;
    const uint64_t motion = pixels * (luma + 1);
    return low.height * row * pictures + CostVolume::scratch_bytes(low) + GuidedFilter::scratch_bytes(low) +
           FocusVolume::scratch_bytes(shape, low) + FocusPyramid::memory(low) +
           pixels * (3 * sizeof(cl_ushort) + 1) + motion;
}

void VolumeMethod::measure(const StackBuffer &stack)
{
    Stages &s = *stages_;
    s.noise.run(stack);
    s.small.run(stack);
    s.focus.run(stack, s.noise);
    s.pyramid.run(s.small, s.noise, stack);
    blur_ = s.blur_step.read(s.focus, s.pyramid, s.noise, blur_);
}

void VolumeMethod::run(const StackBuffer &stack, DepthCoder &coder, const Wanted &wanted,
                       const cl::Buffer &depth)
{
    measure(stack);
    const auto now = stages_->low.scale;
    const unsigned scale =
        parameters_.scale == 0 ? LowShape::scale_for(shape_, blur_.step, now) : parameters_.scale;
    if (static_cast<cl_int>(scale) != now) {
        stages_.reset();
        stages_ = std::make_unique<Stages>(queue_, shape_, scale);
        measure(stack.as_new());
    }
    Stages &s = *stages_;
    s.cost.run_fine(s.floor.run(s.focus, s.small, s.noise), s.noise);
    s.cost.run_coarse(s.small, s.noise, blur_.step);
    if (parameters_.prefer != Prefer::Clearest) {
        if (!s.seen_through)
            s.seen_through.emplace(queue_, s.low);
        s.seen_through->run(s.cost, s.noise, parameters_.prefer);
    }
    s.cost.run_guess(s.noise);
    s.guide.run(s.cost, s.small, s.noise);
    s.filter.run(s.cost.cost(), s.guide.guide(), s.noise);
    s.filter.doubt(s.guide.nearer(), s.noise);
    s.matching.run(s.filter.filtered(), s.guide.guide(), s.noise);
    s.doubt.run(s.matching, s.filter.filtered(), s.noise, blur_.step);
    if (wanted.uncertainty) {
        if (!s.uncertainty)
            s.uncertainty.emplace(queue_, shape_, s.low);
        s.uncertainty->remember_matched(s.matching.u());
    }
    s.sub_plane.run(s.matching.u(), s.focus, s.pyramid, s.noise, blur_.step);
    if (wanted.uncertainty)
        s.uncertainty->remember_decided(s.matching.u());
    s.fill.run(s.matching, blur_.t, blur_.step);
    s.guide.run_at(s.matching.u(), s.small, s.noise);
    s.upsampling.run(s.matching.u(), s.guide, s.cost, s.noise, stack, coder, depth);

    if (wanted.uncertainty)
        s.uncertainty->run(s.matching.u(), s.fill, s.filter.filtered(), s.noise, coder, depth);
    const bool mask_motion = wanted.sparse && parameters_.motion_mask;
    if (wanted.motion || mask_motion)
        run_motion(stack);
    if (wanted.confidence || wanted.sparse)
        s.upsampling.run_confidence(s.matching, s.cost);
    if (wanted.sparse)
        s.upsampling.run_sparse(depth, s.fill, mask_motion ? entropy_.get() : nullptr);
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
