/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/bilateral_grid.h"
#include "engine/gaussian_blur.h"
#include "optics/depth_scale.h"

namespace dff {

/* Parameters of method=paper: Oliva-García 2022, section 2.3. */
struct DepthParameters {
    unsigned levels = 3;       /* pictures of falling resolution in the focus measure (2) */
    float tolerance = 1.4f;    /* a kept peak stands so many times above the mean over the planes */
    bool motion_mask = true;   /* leave pixels that moved during the sweep out of the sparse map (3) */
    float entropy_bits = 2.0f; /* entropy along z above which a pixel moved */
    BilateralGrid::Parameters grid;
};

/* A picture in host memory that an engine writes. Rows of `width` pixels follow each other after `stride`
 * bytes. */
struct OutputPicture {
    std::byte *pixels = nullptr; /* nullptr: not wanted */
    size_t stride = 0;
};

/* Which maps to compute, and where they go. */
struct DepthOutputs {
    OutputPicture depth;      /* 16 bits */
    OutputPicture sparse;     /* 16 bits, 0 where unknown */
    OutputPicture confidence; /* 8 bits: 255 c */
    OutputPicture motion;     /* 8 bits: 255 where it moved during the sweep */
};

/* Depth from focal stacks of one shape. Not to be used from two threads at once. */
class FocusEngine {
public:
    /* Throws EngineError: TooLarge before anything is allocated if the stack would need over half of the
     * device's memory. */
    FocusEngine(std::shared_ptr<Device> device, const StackShape &shape, const DepthParameters &parameters);

    /* What the pixels of the depth maps mean from now on; DepthEncoder::index() until then. */
    void set_encoder(const DepthEncoder &encoder);

    /* Computes what `outputs` asks for. Returns false if no pixel's depth could be told: the depth map is
     * then 0. Throws EngineError. */
    bool compute(const StackView &stack, const DepthOutputs &outputs);

    /* Of the last stack. */
    const StageTimes &times() const { return times_; }

private:
    void read_outputs(const DepthOutputs &outputs);
    void read(const cl::Buffer &picture, size_t pixel_bytes, const OutputPicture &output);

    std::shared_ptr<Device> device_;
    StackShape shape_;
    DepthParameters parameters_;
    CommandQueue queue_;
    StackBuffer stack_;
    Luma luma_;
    FocusMeasure focus_;
    ZEntropy entropy_;
    SparseDepth sparse_;
    ReferenceImage reference_;
    BilateralGrid grid_;
    GaussianBlur blur_;
    cl::Kernel code_positions_, code_planes_;
    cl::Buffer codes_, depth_, sparse_depth_;
    StageTimes times_;
};

} // namespace dff
