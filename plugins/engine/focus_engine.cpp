/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/focus_engine.h"

#include "engine/engine_error.h"

namespace dff {

namespace {

std::shared_ptr<Device> with_room(std::shared_ptr<Device> device, const StackShape &shape)
{
    uint64_t bytes = 0;
    for (const Component &component : shape.components())
        bytes += uint64_t{component.width} * component.height * component.sample_bytes * shape.planes;
    if (bytes > device->global_memory() / 2 || bytes > device->largest_allocation())
        throw EngineError(
            EngineError::Kind::TooLarge,
            "A stack of " + std::to_string(shape.planes) + " planes of " + std::to_string(shape.width) + "x" +
                std::to_string(shape.height) + " has " + std::to_string(bytes >> 20) +
                " MiB; the OpenCL device " + device->name() + " has " +
                std::to_string(device->global_memory() >> 20) + " MiB and takes " +
                std::to_string(device->largest_allocation() >> 20) +
                " MiB at once, and at most half may be used: use smaller pictures, fewer planes or "
                "another device");
    return device;
}

} // namespace

FocusEngine::FocusEngine(std::shared_ptr<Device> device, const StackShape &shape,
                         const DepthParameters &parameters)
    : device_(with_room(std::move(device), shape)), shape_(shape), parameters_(parameters), queue_(device_),
      stack_(queue_, shape), luma_(queue_, shape), focus_(queue_, shape, parameters.levels),
      entropy_(queue_, shape, parameters.entropy_bits), sparse_(queue_, shape, parameters.tolerance),
      reference_(queue_, shape, parameters.grid.sigma_chroma != 0), grid_(queue_, shape, parameters.grid),
      blur_(queue_, shape.width, shape.height, GaussianBlur::taps_for(parameters.grid.sigma_xy)),
      codes_(queue_.allocate((DepthScale::max_pixel + 1) * sizeof(cl_ushort))),
      depth_(queue_.allocate(size_t{shape.width} * shape.height * sizeof(cl_ushort)))
{
    const Program program(*device_, "depth_code");
    code_positions_ = program.kernel("code_positions");
    code_planes_ = program.kernel("code_planes");
    set_encoder(DepthEncoder::index(shape.planes));
}

void FocusEngine::set_encoder(const DepthEncoder &encoder)
{
    std::vector<cl_ushort> codes(DepthScale::max_pixel + 1, DepthScale::no_value);
    for (unsigned i = 1; i < codes.size(); i++)
        codes[i] =
            encoder.encode((shape_.planes - 1) * (i - 1) / static_cast<double>(DepthScale::max_pixel - 1));
    queue_.commands().enqueueWriteBuffer(codes_, CL_TRUE, 0, codes.size() * sizeof(cl_ushort), codes.data());
}

bool FocusEngine::compute(const StackView &stack, const DepthOutputs &outputs)
{
    bool known = false;
    translate_errors(*device_, [&] {
        stack_.assign(stack);
        luma_.run(stack_);
        focus_.run(luma_);
        if (parameters_.motion_mask || outputs.motion.pixels)
            entropy_.run(luma_);
        sparse_.run(focus_, parameters_.motion_mask ? &entropy_ : nullptr);
        reference_.run(stack_, luma_);
        grid_.run(sparse_, reference_);
        blur_.run(grid_.u());

        queue_.begin_stage("code");
        queue_.run(code_positions_, {shape_.width, shape_.height}, grid_.u(), codes_, depth_,
                   static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.planes));
        read_outputs(outputs);
        times_ = queue_.finish();

        cl_ushort first = DepthScale::no_value;
        queue_.commands().enqueueReadBuffer(depth_, CL_TRUE, 0, sizeof first, &first);
        known = first != DepthScale::no_value;
    });
    return known;
}

void FocusEngine::read_outputs(const DepthOutputs &outputs)
{
    if (outputs.sparse.pixels) {
        if (!sparse_depth_())
            sparse_depth_ = queue_.allocate(size_t{shape_.width} * shape_.height * sizeof(cl_ushort));
        queue_.run(code_planes_, {shape_.width, shape_.height}, sparse_.planes(), codes_, sparse_depth_,
                   static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.planes));
        read(sparse_depth_, sizeof(cl_ushort), outputs.sparse);
    }
    if (outputs.confidence.pixels) {
        sparse_.run_confidence(focus_);
        read(sparse_.confidence(), sizeof(cl_uchar), outputs.confidence);
    }
    if (outputs.motion.pixels)
        read(entropy_.moved(), sizeof(cl_uchar), outputs.motion);
    read(depth_, sizeof(cl_ushort), outputs.depth);
}

void FocusEngine::read(const cl::Buffer &picture, size_t pixel_bytes, const OutputPicture &output)
{
    const size_t row_bytes = shape_.width * pixel_bytes;
    queue_.commands().enqueueReadBufferRect(picture, CL_FALSE, {0, 0, 0}, {0, 0, 0},
                                            {row_bytes, shape_.height, 1}, row_bytes, 0, output.stride, 0,
                                            output.pixels);
}

} // namespace dff
