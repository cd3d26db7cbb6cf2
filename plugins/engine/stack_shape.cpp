/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/stack_shape.h"

namespace dff {

uint32_t sample_bytes(PixelFormat format)
{
    return format == PixelFormat::Gray16 || format == PixelFormat::Rgba64 ? 2 : 1;
}

std::vector<Component> StackShape::components() const
{
    const uint32_t half_width = (width + 1) / 2, half_height = (height + 1) / 2;
    switch (format) {
    case PixelFormat::Gray8:
        return {{width, height, 1, 1, 1}};
    case PixelFormat::Gray16:
        return {{width, height, 1, 1, 2}};
    case PixelFormat::I420:
        return {
            {width, height, 1, 1, 1}, {half_width, half_height, 1, 2, 1}, {half_width, half_height, 1, 2, 1}};
    case PixelFormat::Nv12:
        return {{width, height, 1, 1, 1}, {2 * half_width, half_height, 2, 2, 1}};
    case PixelFormat::Rgb:
    case PixelFormat::Bgr:
        return {{3 * width, height, 3, 1, 1}};
    case PixelFormat::Rgbx:
    case PixelFormat::Bgrx:
        return {{4 * width, height, 4, 1, 1}};
    case PixelFormat::Rgba64:
        return {{4 * width, height, 4, 1, 2}};
    }
    return {};
}

uint64_t bytes_of(const StackShape &shape)
{
    uint64_t bytes = 0;
    for (const Component &component : shape.components())
        bytes += uint64_t{component.width} * component.height * component.sample_bytes * shape.planes;
    return bytes;
}

bool lies_within(const Component &component, const RowLayout &rows, uint64_t bytes)
{
    /* Without overflow, whatever offset and stride say. */
    const uint64_t row = uint64_t{component.width} * component.sample_bytes, last = component.height - 1;
    if (rows.stride < row || rows.offset > bytes || bytes - rows.offset < row)
        return false;
    return last == 0 || rows.stride <= (bytes - rows.offset - row) / last;
}

bool lies_within_memory(const StackView &stack)
{
    const std::vector<Component> components = stack.shape.components();
    if (stack.layout.size() != components.size() * stack.shape.planes)
        return false;
    for (size_t i = 0; i < stack.layout.size(); i++)
        if (!lies_within(components[i / stack.shape.planes], stack.layout[i], stack.memory.size()))
            return false;
    return true;
}

std::vector<RowLayout> packed_layout(const StackShape &shape)
{
    const std::vector<Component> components = shape.components();
    std::vector<RowLayout> layout(components.size() * shape.planes);
    uint64_t offset = 0;
    for (uint32_t z = 0; z < shape.planes; z++)
        for (size_t c = 0; c < components.size(); c++) {
            const uint64_t stride = uint64_t{components[c].width} * components[c].sample_bytes;
            layout[c * shape.planes + z] = {offset, stride};
            offset += stride * components[c].height;
        }
    return layout;
}

} // namespace dff
