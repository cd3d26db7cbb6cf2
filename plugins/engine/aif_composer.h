/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/depth_reach.h"
#include "engine/focus_engine.h"
#include "engine/noise_estimate.h"
#include "engine/sharp_blend.h"

#include <optional>

namespace dff {

/* All-in-focus pictures from stacks of one shape and their depth maps. Not to be used from two threads at
 * once. */
class AifComposer {
public:
    enum class Blend {
        Linear, /* between the two planes around the depth */
        Soft,   /* in noise a Gaussian over the neighbouring planes, which averages it; else as Linear */
        Sharp,  /* the sharper ones of the planes around the depth: forgives planes far apart */
    };

    /* Pictures have 64x64 pixels or more. Throws EngineError. */
    AifComposer(std::shared_ptr<Device> device, const StackShape &shape);

    /* What the pixels of the depth maps mean from now on; DepthEncoder::index() until then. */
    void set_encoder(const DepthEncoder &encoder);

    /* A 16-bit depth map of the stack's size; its stride in bytes must be even. */
    struct DepthView {
        std::span<const std::byte> memory;
        size_t stride;
        float blur_step = 0.0f; /* pixels of circle of confusion a plane; 0: not known */
    };

    /* Writes the picture, in the stack's format, component c at `picture + layout[c].offset`. All take
     * the depth no farther than where the blur of what is nearer beside it reaches (kernels/depth_reach.cl),
     * Linear and Soft softened (kernels/soften_depth.cl), since a step in it would show. Pixels without a
     * depth become the mean of all planes. Throws EngineError. */
    void compose(const StackView &stack, const DepthView &depth, Blend blend, std::span<std::byte> picture,
                 std::span<const RowLayout> layout);

    /* Of the last picture. */
    const StageTimes &times() const { return times_; }

private:
    /* The output and what is read of the depth map, on the device. */
    struct Pictures {
        cl::Buffer depth, output;
        size_t depth_stride;
    };

    void write_positions(const DepthEncoder &encoder);
    void write_fixed_positions(const DepthEncoder &encoder);
    void limit_depth(Pictures &pictures, float blur_step);
    void compose_sharp(const Pictures &pictures, std::span<const RowLayout> layout);
    void compose_pixels(const Pictures &pictures, std::span<const RowLayout> layout, Blend blend);
    void compose_strips(const Pictures &pictures, std::span<const RowLayout> layout, Blend blend);

    std::shared_ptr<Device> device_;
    StackShape shape_;
    std::vector<Component> components_;
    CommandQueue queue_;
    StackBuffer stack_;
    HostBuffer depth_, picture_;
    bool in_strips_; /* many samples of 8 bits at once, on a CPU */
    NoiseEstimate noise_;
    cl::Kernel nearest_pixel_, mean_pixel_, compose_;
    cl::Buffer nearest_, softened_; /* of compose_pixels() */
    cl::Buffer picture_components_; /* of compose_strips(): where the picture of picture_layout_ lies */
    std::vector<RowLayout> picture_layout_;
    cl::Buffer positions_;
    float position_scale_ =
        0.0f; /* of aif_strips.cl: positions a depth pixel, 0 where they must be looked up */
    DepthEncoder encoder_;
    std::optional<SharpBlend> sharp_; /* made at its first use */
    std::optional<DepthReach> reach_; /* likewise */
    StageTimes times_;
};

} // namespace dff
