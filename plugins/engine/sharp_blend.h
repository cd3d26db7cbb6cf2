/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/sharp_weights.h"

namespace dff {

/* The all-in-focus picture of AifComposer::Blend::Sharp: the sharper ones of the planes around the depth,
 * blended in bands of detail. Beside the stack it keeps about a byte and a half a sample and two a pixel of
 * every plane. */
class SharpBlend {
public:
    SharpBlend(CommandQueue &queue, const StackShape &shape, const DepthEncoder &encoder);

    void set_encoder(const DepthEncoder &encoder) { weights_.set_encoder(encoder); }

    /* Writes the picture, component c at `layout[c]`. `depth_stride` is in pixels. */
    void run(const StackBuffer &stack, const cl::Buffer &depth, size_t depth_stride,
             const cl::Buffer &picture, std::span<const RowLayout> layout);

private:
    /* One component: its kernels, and of each level above its first the planes and the blend,
     * [channel][plane] and [channel]. */
    struct Pyramid {
        Component component;
        cl_int first_row; /* in the stack's table */
        size_t first;     /* level at which its samples are the cells */
        cl::Kernel shrink_samples, shrink, blend_top, blend, blend_samples;
        std::array<cl::Buffer, PyramidShape::top + 1> planes, result;
    };

    Pyramid make_pyramid(const Component &component, size_t index);
    void shrink(Pyramid &pyramid, const StackBuffer &stack);
    void blend(Pyramid &pyramid, const StackBuffer &stack, const cl::Buffer &picture,
               const RowLayout &layout);

    CommandQueue &queue_;
    StackShape shape_;
    PyramidShape shapes_;
    SharpWeights weights_;
    std::vector<Pyramid> pyramids_;
};

} // namespace dff
