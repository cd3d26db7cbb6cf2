/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/small_planes.h"

#include "engine/luma.h"

namespace dff {

SmallPlanes::SmallPlanes(CommandQueue &queue, const StackShape &shape, const LowShape &low)
    : queue_(queue), shape_(shape), low_(low), colours_(low.allocate(queue, size_t{3} * shape.planes))
{
    const std::vector<Component> components = shape.components();
    const char *conversion = nullptr;
    switch (shape.format) {
    case PixelFormat::Gray8:
    case PixelFormat::Gray16:
        average(0, components[0], {{0, -1, -1, -1}});
        conversion = "colours_of_gray";
        break;
    case PixelFormat::I420:
        for (cl_int c = 0; c < 3; c++)
            average(c, components[c], {{c, -1, -1, -1}});
        conversion = "colours_of_yuv";
        break;
    case PixelFormat::Nv12:
        average(0, components[0], {{0, -1, -1, -1}});
        average(1, components[1], {{1, 2, -1, -1}});
        conversion = "colours_of_yuv";
        break;
    case PixelFormat::Rgb:
    case PixelFormat::Rgbx:
        average(0, components[0], {{0, 1, 2, -1}});
        break;
    case PixelFormat::Bgr:
    case PixelFormat::Bgrx:
        average(0, components[0], {{2, 1, 0, -1}});
        break;
    }
    if (conversion)
        convert_ = Program(queue.device(), "small_planes", "-DBOX=2 -DCHANNELS=1 -DSAMPLE_BYTES=1")
                       .kernel(conversion);
}

void SmallPlanes::average(size_t component, const Component &shape, cl_int4 places)
{
    const Program program(queue_.device(), "small_planes",
                          "-DBOX=" + std::to_string(low_.scale / static_cast<cl_int>(shape.subsampling)) +
                              " -DCHANNELS=" + std::to_string(shape.channels) +
                              " -DSAMPLE_BYTES=" + std::to_string(shape.sample_bytes));
    averagings_.push_back({program.kernel("average_squares"), static_cast<cl_int>(component * shape_.planes),
                           static_cast<cl_int>(shape.width / shape.channels), places});
}

void SmallPlanes::run(const StackBuffer &stack)
{
    queue_.begin_stage("small-planes");
    for (Averaging &averaging : averagings_)
        queue_.run(averaging.kernel, low_.rows_of_planes(), stack.bytes(), stack.layout(),
                   averaging.first_row, colours_, averaging.width, low_.width, low_.stride, averaging.places);
    if (convert_())
        queue_.run(convert_, low_.rows_of_planes(), colours_, low_.width, low_.stride);
}

} // namespace dff
