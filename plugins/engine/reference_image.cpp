/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/reference_image.h"

namespace dff {

ReferenceImage::ReferenceImage(CommandQueue &queue, const StackShape &shape, bool with_chroma)
    : queue_(queue), shape_(shape), with_chroma_(with_chroma)
{
    const Program program(queue.device(), "reference_image", Luma::build_options(shape.format));
    mean_luma_ = program.kernel("mean_luma");
    mean_chroma_ = program.kernel("mean_chroma");
    mean_chroma_of_colours_ = program.kernel("mean_chroma_of_colours");

    const size_t pixels = size_t{shape.width} * shape.height;
    y_ = queue.allocate(pixels);
    u_ = queue.allocate(with_chroma ? pixels : 1);
    v_ = queue.allocate(with_chroma ? pixels : 1);
}

void ReferenceImage::run(const StackBuffer &stack, const Luma &luma)
{
    queue_.begin_stage("reference");
    queue_.run(mean_luma_, {shape_.width, shape_.height}, luma.bytes(), luma.rows(), y_,
               static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.planes));
    if (with_chroma_)
        run_chroma(stack);
}

void ReferenceImage::run_chroma(const StackBuffer &stack)
{
    const cl::NDRange pixels(shape_.width, shape_.height);
    const auto width = static_cast<cl_int>(shape_.width), planes = static_cast<cl_int>(shape_.planes);

    if (is_interleaved(shape_.format)) {
        queue_.run(mean_chroma_of_colours_, pixels, stack.bytes(), stack.layout(), u_, v_, width, planes,
                   colour_channels(shape_.format));
        return;
    }
    if (shape_.format != PixelFormat::I420 && shape_.format != PixelFormat::Nv12) {
        queue_.commands().enqueueFillBuffer(u_, cl_uchar{128}, 0, size_t{shape_.width} * shape_.height);
        queue_.commands().enqueueFillBuffer(v_, cl_uchar{128}, 0, size_t{shape_.width} * shape_.height);
        return;
    }

    const bool interleaved = shape_.format == PixelFormat::Nv12;
    const cl_int step = interleaved ? 2 : 1, second = interleaved ? planes : 2 * planes;
    queue_.run(mean_chroma_, pixels, stack.bytes(), stack.layout(), planes, u_, width, planes, step,
               cl_int{0});
    queue_.run(mean_chroma_, pixels, stack.bytes(), stack.layout(), second, v_, width, planes, step,
               cl_int{interleaved ? 1 : 0});
}

} // namespace dff
