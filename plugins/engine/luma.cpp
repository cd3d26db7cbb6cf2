/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/luma.h"

namespace dff {

bool is_interleaved(PixelFormat format)
{
    return format == PixelFormat::Rgb || format == PixelFormat::Bgr || format == PixelFormat::Rgbx ||
           format == PixelFormat::Bgrx || format == PixelFormat::Rgba64;
}

cl_int4 colour_channels(PixelFormat format)
{
    if (format == PixelFormat::I420)
        return {{1, 0, 1, 0}};
    if (format == PixelFormat::Nv12)
        return {{2, 0, 2, 1}};
    const bool blue_first = format == PixelFormat::Bgr || format == PixelFormat::Bgrx;
    const int samples = format == PixelFormat::Rgb || format == PixelFormat::Bgr ? 3 : 4;
    return {{samples, blue_first ? 2 : 0, 1, blue_first ? 0 : 2}};
}

std::string Luma::build_options(PixelFormat format)
{
    return "-DLUMA_BYTES=" + std::to_string(sample_bytes(format));
}

std::string colour_options(PixelFormat format)
{
    std::string options = Luma::build_options(format);
    if (is_interleaved(format))
        return options + " -DINTERLEAVED -DCHANNELS=" + std::to_string(colour_channels(format).s[0]);
    if (format == PixelFormat::I420)
        return options + " -DCHROMA -DV_COMPONENT=2";
    if (format == PixelFormat::Nv12)
        return options + " -DCHROMA -DV_COMPONENT=1";
    return options;
}

Luma::Luma(CommandQueue &queue, const StackShape &shape) : queue_(queue), shape_(shape)
{
    if (!is_interleaved(shape.format))
        return;
    kernel_ = Program(queue.device(), "luma", build_options(shape.format)).kernel("luma_of_colours");
    const StackShape luma{sample_bytes(shape.format) == 2 ? PixelFormat::Gray16 : PixelFormat::Gray8,
                          shape.width, shape.height, shape.planes};
    bytes_ = queue.allocate(bytes_of(luma));
    rows_ = queue.allocate(shape.planes * sizeof(RowLayout));

    const std::vector<RowLayout> rows = packed_layout(luma);
    queue.commands().enqueueWriteBuffer(rows_, CL_TRUE, 0, rows.size() * sizeof(RowLayout), rows.data());
}

void Luma::run(const StackBuffer &stack)
{
    queue_.begin_stage("luma");
    if (!is_interleaved(shape_.format)) {
        bytes_ = stack.bytes();
        rows_ = stack.layout();
        return;
    }
    queue_.run(kernel_, {shape_.width, shape_.height, shape_.planes}, stack.bytes(), stack.layout(), bytes_,
               static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.height),
               colour_channels(shape_.format));
}

} // namespace dff
