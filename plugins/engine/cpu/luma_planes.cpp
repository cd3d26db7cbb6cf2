/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/cpu/luma_planes.h"

namespace dff {

namespace {

/* The kernel of luma_planes.cl for a format; nullptr where the stack holds luma of 8 bits. */
const char *kernel_for(PixelFormat format)
{
    switch (format) {
    case PixelFormat::Rgb:
    case PixelFormat::Bgr:
        return "luma_of_3_bytes";
    case PixelFormat::Rgbx:
    case PixelFormat::Bgrx:
        return "luma_of_4_bytes";
    case PixelFormat::Gray16:
        return "luma_of_16_bits";
    case PixelFormat::Rgba64:
        return "luma_of_4_shorts";
    default:
        return nullptr;
    }
}

} // namespace

LumaPlanes::LumaPlanes(CommandQueue &queue, const StackShape &shape)
    : queue_(queue), shape_(shape), in_place_(!kernel_for(shape.format))
{
    if (in_place_)
        return;
    kernel_ = Program(queue.device(), "luma_planes").kernel(kernel_for(shape.format));
    bytes_ = queue.allocate(size_t{shape.width} * shape.height * shape.planes);
    rows_ = queue.allocate(shape.planes * sizeof(RowLayout));

    const std::vector<RowLayout> rows =
        packed_layout({PixelFormat::Gray8, shape.width, shape.height, shape.planes});
    queue.commands().enqueueWriteBuffer(rows_, CL_TRUE, 0, rows.size() * sizeof(RowLayout), rows.data());
}

void LumaPlanes::run(const StackBuffer &stack)
{
    queue_.begin_stage("luma");
    if (in_place_) {
        bytes_ = stack.bytes();
        rows_ = stack.layout();
        return;
    }
    const bool blue_first = shape_.format == PixelFormat::Bgr || shape_.format == PixelFormat::Bgrx;
    queue_.run_groups(kernel_, {shape_.height, shape_.planes}, stack.bytes(), stack.layout(), bytes_,
                      static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.height),
                      static_cast<cl_int>(blue_first));
}

} // namespace dff
