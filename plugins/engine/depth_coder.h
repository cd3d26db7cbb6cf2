/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/command_queue.h"
#include "engine/stack_shape.h"
#include "optics/depth_scale.h"

namespace dff {

/* Turns plane positions on the device into the pixels of a depth map. */
class DepthCoder {
public:
    DepthCoder(CommandQueue &queue, const StackShape &shape);

    /* What the pixels mean from now on; DepthEncoder::index() until then. */
    void set_encoder(const DepthEncoder &encoder);

    /* ushort[65536]: the pixel for each position, as depth_code.cl numbers them. */
    const cl::Buffer &codes() const { return codes_; }

    /* float[65536]: by how many steps of the map a plane changes the pixel, at each pixel. */
    const cl::Buffer &slopes();

    /* A position's pixel is its number, so that nobody needs to look it up. */
    bool is_linear() const { return is_linear_; }

    /* ushort[height][width] from float positions, 0 from NAN. */
    void code_positions(const cl::Buffer &positions, const cl::Buffer &depth);

    /* ushort[height][width] from uchar half planes, 0 from SparseDepth::unknown_plane. */
    void code_places(const cl::Buffer &places, const cl::Buffer &depth);

private:
    CommandQueue &queue_;
    StackShape shape_;
    cl::Kernel code_positions_, code_places_;
    cl::Buffer codes_, slopes_;
    DepthEncoder encoder_;
    bool has_slopes_ = false; /* of encoder_ */
    bool is_linear_ = true;
};

} // namespace dff
