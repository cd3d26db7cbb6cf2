/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/sharp_blend.h"

namespace dff {

SharpBlend::SharpBlend(CommandQueue &queue, const StackShape &shape, const DepthEncoder &encoder)
    : queue_(queue), shape_(shape), components_(shape.components()), luma_(queue, shape),
      positions_(queue.allocate((DepthScale::max_pixel + 1) * sizeof(cl_float)))
{
    const char *sample = shape.format == PixelFormat::Gray16 ? " -DSAMPLE=ushort" : " -DSAMPLE=uchar";
    const Program program(queue.device(), "sharp_blend", Luma::build_options(shape.format) + sample);
    gradient_ = program.kernel("gradient");
    box_ = program.kernel("box");
    compose_sharp_ = program.kernel("compose_sharp");
    const size_t samples = size_t{shape.width} * shape.height * shape.planes;
    sharpness_ = queue.allocate(samples * sizeof(cl_ushort));
    half_boxed_ = queue.allocate(samples * sizeof(cl_ushort));
    set_encoder(encoder);
}

void SharpBlend::set_encoder(const DepthEncoder &encoder)
{
    std::vector<cl_float> positions(DepthScale::max_pixel + 1);
    for (unsigned pixel = 0; pixel < positions.size(); pixel++)
        positions[pixel] = static_cast<cl_float>(encoder.decode(static_cast<uint16_t>(pixel)).value_or(-1.0));
    queue_.commands().enqueueWriteBuffer(positions_, CL_TRUE, 0, positions.size() * sizeof(cl_float),
                                         positions.data());
}

void SharpBlend::measure(const StackBuffer &stack)
{
    const cl::NDRange samples(shape_.width, shape_.height, shape_.planes);
    const auto width = static_cast<cl_int>(shape_.width), height = static_cast<cl_int>(shape_.height);

    luma_.run(stack);
    queue_.begin_stage("sharpness");
    queue_.run(gradient_, samples, luma_.bytes(), luma_.rows(), sharpness_, width, height);
    queue_.run(box_, samples, sharpness_, half_boxed_, width, height, cl_int{1}, cl_int{0});
    queue_.run(box_, samples, half_boxed_, sharpness_, width, height, cl_int{0}, cl_int{1});
}

void SharpBlend::compose(const StackBuffer &stack, size_t component, const cl::Buffer &depth,
                         size_t depth_stride, const cl::Buffer &picture, const RowLayout &picture_rows)
{
    const Component &c = components_[component];
    const cl_int2 component_size{{static_cast<cl_int>(c.width), static_cast<cl_int>(c.height)}};
    const cl_int2 size{{static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.height)}};
    queue_.run(compose_sharp_, {c.width, c.height}, stack.bytes(), stack.layout(),
               static_cast<cl_int>(component * shape_.planes), sharpness_, depth, positions_, picture,
               cl_ulong2{{picture_rows.offset, picture_rows.stride}}, component_size,
               static_cast<cl_int>(c.channels), static_cast<cl_int>(c.subsampling), size,
               static_cast<cl_int>(depth_stride), static_cast<cl_int>(shape_.planes));
}

} // namespace dff
