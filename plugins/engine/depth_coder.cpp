/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/depth_coder.h"

#include "engine/opencl/program.h"

namespace dff {

DepthCoder::DepthCoder(CommandQueue &queue, const StackShape &shape)
    : queue_(queue), shape_(shape), codes_(queue.allocate((DepthScale::max_pixel + 1) * sizeof(cl_ushort))),
      encoder_(DepthEncoder::index(shape.planes))
{
    const Program program(queue.device(), "depth_code");
    code_positions_ = program.kernel("code_positions");
    code_places_ = program.kernel("code_places");
    set_encoder(encoder_);
}

void DepthCoder::set_encoder(const DepthEncoder &encoder)
{
    std::vector<cl_ushort> codes(DepthScale::max_pixel + 1, DepthScale::no_value);
    is_linear_ = true;
    for (unsigned i = 1; i < codes.size(); i++) {
        codes[i] =
            encoder.encode((shape_.planes - 1) * (i - 1) / static_cast<double>(DepthScale::max_pixel - 1));
        is_linear_ = is_linear_ && codes[i] == i;
    }
    queue_.commands().enqueueWriteBuffer(codes_, CL_TRUE, 0, codes.size() * sizeof(cl_ushort), codes.data());
    encoder_ = encoder;
    has_slopes_ = false;
}

const cl::Buffer &DepthCoder::slopes()
{
    if (has_slopes_)
        return slopes_;
    std::vector<cl_float> slopes(DepthScale::max_pixel + 1, 0.0f);
    for (unsigned i = 1; i < slopes.size(); i++)
        slopes[i] = static_cast<cl_float>(encoder_.slope(*encoder_.decode(static_cast<uint16_t>(i))));
    if (!slopes_())
        slopes_ = queue_.allocate(slopes.size() * sizeof(cl_float));
    queue_.commands().enqueueWriteBuffer(slopes_, CL_TRUE, 0, slopes.size() * sizeof(cl_float),
                                         slopes.data());
    has_slopes_ = true;
    return slopes_;
}

void DepthCoder::code_positions(const cl::Buffer &positions, const cl::Buffer &depth)
{
    queue_.run(code_positions_, {shape_.width, shape_.height}, positions, codes_, depth,
               static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.planes));
}

void DepthCoder::code_places(const cl::Buffer &places, const cl::Buffer &depth)
{
    queue_.run(code_places_, {shape_.width, shape_.height}, places, codes_, depth,
               static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.planes));
}

} // namespace dff
