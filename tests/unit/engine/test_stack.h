/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/command_queue.h"
#include "engine/opencl/stack_buffer.h"

#include <vector>

namespace dff {

/* A stack of random texture, each pixel sharpest in a plane that varies over the picture, in packed layout.
 */
struct TestStack {
    explicit TestStack(const StackShape &shape, unsigned seed = 1);

    StackView view() const { return {shape, memory, layout}; }
    uint8_t sample(size_t component, unsigned x, unsigned y, unsigned z) const; /* byte x of the row */
    unsigned value(size_t component, unsigned x, unsigned y,
                   unsigned z) const;                                     /* sample x, of 8 or 16 bits */
    float dn(size_t component, unsigned x, unsigned y, unsigned z) const; /* that in DN of 8 bits */

    StackShape shape;
    std::vector<RowLayout> layout;
    std::vector<std::byte> memory;
};

/* Texture of six planes, of which `equal` from `first` on are the same and show it most. */
TestStack stack_with_equal_planes(unsigned first, unsigned equal);

/* The default device, whatever it is, with kernels of one style. */
std::shared_ptr<Device> device_with(KernelStyle style);

/* A float picture a plane: value(x, y, z). */
struct Volume {
    Volume(unsigned width, unsigned height, unsigned planes)
        : width(width), height(height), planes(planes), values(size_t{width} * height * planes)
    {
    }

    float &at(unsigned x, unsigned y, unsigned z = 0) { return values[(size_t{z} * height + y) * width + x]; }
    float at(unsigned x, unsigned y, unsigned z = 0) const
    {
        return values[(size_t{z} * height + y) * width + x];
    }

    unsigned width, height, planes;
    std::vector<float> values;
};

/* Copies a device buffer of `count` T to the host. */
template <typename T> std::vector<T> read_back(CommandQueue &queue, const cl::Buffer &buffer, size_t count)
{
    std::vector<T> values(count);
    queue.commands().enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(T), values.data());
    return values;
}

} // namespace dff
