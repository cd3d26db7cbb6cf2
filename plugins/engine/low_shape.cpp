/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/low_shape.h"

#include "engine/engine_error.h"

#include <algorithm>

namespace dff {

namespace {

/* 4 at Full HD, 2 near VGA. */
constexpr uint64_t pixels_for_scale_4 = 800 * 600 + 1;

/* Pixels of blur a plane above which cells of 2 pixels see too little change, and below which those of 4 see
 * too little detail: apart, so that a stream does not go to and fro. */
constexpr float step_for_scale_4 = 6.5f, step_for_scale_2 = 4.5f;

bool is_large(const StackShape &shape)
{
    return uint64_t{shape.width} * shape.height >= pixels_for_scale_4;
}

unsigned choose_scale(const StackShape &shape, unsigned wish)
{
    if (wish != 0 && wish != 2 && wish != 4 && wish != 8)
        throw EngineError(EngineError::Kind::Failed,
                          "The volume's scale can be 2, 4, 8 or 0 (by size), not " + std::to_string(wish));
    if (wish != 0)
        return wish;
    return is_large(shape) ? 4 : 2;
}

/* Whole cache lines, and an odd number of them, so that cells above each other share no cache set. */
cl_int stride_for(cl_int width)
{
    const cl_int lines = (width + 2 * LowShape::side + 15) / 16;
    return (lines | 1) * 16;
}

/* An even number of strips of about 24 rows: few enough that what overlaps at their ends costs little, and
 * equal shares for two processors. */
cl_int strip_for(cl_int height)
{
    const cl_int pairs = std::max((height + 24) / 48, 1);
    return (height + 2 * pairs - 1) / (2 * pairs);
}

} // namespace

LowShape::LowShape(const StackShape &shape, unsigned wish)
    : scale(static_cast<cl_int>(choose_scale(shape, wish))), width(static_cast<cl_int>(shape.width) / scale),
      height(static_cast<cl_int>(shape.height) / scale), stride(stride_for(width)),
      planes(static_cast<cl_int>(shape.planes)), strip(strip_for(height))
{
}

unsigned LowShape::scale_for(const StackShape &shape, float blur_step, cl_int now)
{
    return is_large(shape) || blur_step > (now == 4 ? step_for_scale_2 : step_for_scale_4) ? 4 : 2;
}

LowShape LowShape::halved() const
{
    LowShape half = *this;
    half.scale = 2 * scale;
    half.width = width / 2;
    half.height = height / 2;
    half.stride = stride_for(half.width);
    half.strip = strip_for(half.height);
    return half;
}

cl::Buffer LowShape::allocate(CommandQueue &queue, size_t pictures) const
{
    return allocate_rows(queue, pictures * height, sizeof(cl_float));
}

cl::Buffer LowShape::allocate_shorts(CommandQueue &queue, size_t pictures) const
{
    return allocate_rows(queue, pictures * height, sizeof(cl_short));
}

cl::Buffer LowShape::allocate_rows(CommandQueue &queue, size_t rows, size_t cell_bytes) const
{
    const size_t bytes = rows * stride * cell_bytes;
    cl::Buffer buffer = queue.allocate(bytes);
    queue.commands().enqueueFillBuffer(buffer, cl_uint{0}, 0, bytes);
    return buffer;
}

} // namespace dff
