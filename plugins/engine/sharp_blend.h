/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/luma.h"
#include "optics/depth_scale.h"

namespace dff {

/* The all-in-focus picture of AifComposer::Blend::Sharp: the sharper ones of the planes around the depth. It
 * keeps the sharpness of every pixel in every plane, four bytes each. */
class SharpBlend {
public:
    SharpBlend(CommandQueue &queue, const StackShape &shape, const DepthEncoder &encoder);

    void set_encoder(const DepthEncoder &encoder);

    /* Measures the stack's sharpness; before compose(). */
    void measure(const StackBuffer &stack);

    /* Writes one component of the picture. `depth_stride` is in pixels. */
    void compose(const StackBuffer &stack, size_t component, const cl::Buffer &depth, size_t depth_stride,
                 const cl::Buffer &picture, const RowLayout &picture_rows);

private:
    CommandQueue &queue_;
    StackShape shape_;
    std::vector<Component> components_;
    Luma luma_;
    cl::Kernel gradient_, box_, compose_sharp_;
    cl::Buffer sharpness_, half_boxed_, positions_;
};

} // namespace dff
