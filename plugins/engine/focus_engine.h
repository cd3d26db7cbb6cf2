/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/depth_method.h"
#include "engine/depth_parameters.h"

#include <optional>

namespace dff {

/* A picture in host memory that an engine writes. Rows of `width` pixels follow each other after `stride`
 * bytes. */
struct OutputPicture {
    std::byte *pixels = nullptr; /* nullptr: not wanted */
    size_t stride = 0;
};

/* Which maps to compute, and where they go. */
struct DepthOutputs {
    OutputPicture depth;       /* 16 bits */
    OutputPicture sparse;      /* 16 bits, 0 where unknown */
    OutputPicture confidence;  /* 8 bits: 255 c */
    OutputPicture motion;      /* 8 bits: 255 where it moved during the sweep */
    OutputPicture uncertainty; /* 16 bits: one standard deviation, steps of depth; 0 where that is 0 */
};

/* Depth from focal stacks of one shape. Not to be used from two threads at once. */
class FocusEngine {
public:
    /* Throws EngineError (TooLarge) if stack and method would need over half of the device's memory, or the
     * stack more than the device takes at once. */
    static void require_room(const Device &device, const StackShape &shape,
                             const DepthParameters &parameters);

    /* Throws EngineError: as require_room() before anything is allocated. */
    FocusEngine(std::shared_ptr<Device> device, const StackShape &shape, const DepthParameters &parameters);

    /* What the pixels of the depth maps mean from now on; DepthEncoder::index() until then. */
    void set_encoder(const DepthEncoder &encoder);

    /* Computes what `outputs` asks for. Returns false if no pixel's depth could be told: the depth map is
     * then 0. Throws EngineError. */
    bool compute(const StackView &stack, const DepthOutputs &outputs);

    /* Whether a method tells how uncertain depth is; where not, that map is 0. */
    static bool tells_uncertainty(Method method) { return method == Method::Volume; }

    /* Of the last stack. */
    const StageTimes &times() const { return times_; }

    /* What the solver left of the last stack's residual, in parts of the right-hand side, where the method
     * tells. */
    std::optional<float> residual() const { return residual_; }

    /* By how many pixels the circle of confusion grew from plane to plane in the last stack; 0 where the
     * method does not tell. */
    float blur_step() const { return method_->blur_step(); }

private:
    cl::Buffer depth_for(const OutputPicture &output);
    void blank(const OutputPicture &output) const;
    void read(const cl::Buffer &picture, size_t pixel_bytes, const OutputPicture &output);

    std::shared_ptr<Device> device_;
    StackShape shape_;
    CommandQueue queue_;
    StackBuffer stack_;
    DepthCoder coder_;
    std::unique_ptr<DepthMethod> method_;
    cl::Buffer depth_; /* where it is not computed in place */
    StageTimes times_;
    std::optional<float> residual_;
};

} // namespace dff
