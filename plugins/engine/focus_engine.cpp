/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/focus_engine.h"

#include "engine/cpu/cpu_paper_method.h"
#include "engine/engine_error.h"
#include "engine/paper_method.h"
#include "engine/volume_method.h"

#include <cstring>

namespace dff {

namespace {

std::shared_ptr<Device> with_room(std::shared_ptr<Device> device, const StackShape &shape,
                                  const DepthParameters &parameters)
{
    FocusEngine::require_room(*device, shape, parameters);
    return device;
}

std::unique_ptr<DepthMethod> make_method(CommandQueue &queue, const StackShape &shape,
                                         const DepthParameters &parameters)
{
    const KernelStyle style = queue.device().kernel_style(); /* refuses a driver that computes wrong */
    if (parameters.method == Method::Volume)
        return std::make_unique<VolumeMethod>(queue, shape, parameters);
    if (style == KernelStyle::Tiles && parameters.grid.sigma_chroma == 0)
        return std::make_unique<CpuPaperMethod>(queue, shape, parameters);
    return std::make_unique<PaperMethod>(queue, shape, parameters);
}

} // namespace

void FocusEngine::require_room(const Device &device, const StackShape &shape,
                               const DepthParameters &parameters)
{
    dff::require_room(device, shape);
    const uint64_t bytes = bytes_of(shape);
    const uint64_t work = parameters.method == Method::Volume ? VolumeMethod::memory(shape, parameters) : 0;
    if (bytes + work > device.global_memory() / 2)
        throw EngineError(EngineError::Kind::TooLarge,
                          "method=volume needs " + std::to_string(work) + " bytes (" +
                              std::to_string(work >> 20) + " MiB) beside the stack's " +
                              std::to_string(bytes) + "; the OpenCL device " + device.name() + " has " +
                              std::to_string(device.global_memory()) +
                              ", and at most half may be used: use a larger scale, smaller pictures, "
                              "fewer planes or another device");
}

FocusEngine::FocusEngine(std::shared_ptr<Device> device, const StackShape &shape,
                         const DepthParameters &parameters)
    : device_(with_room(std::move(device), shape, parameters)), shape_(shape), queue_(device_),
      stack_(queue_, shape), coder_(queue_, shape), method_(make_method(queue_, shape, parameters))
{
}

void FocusEngine::set_encoder(const DepthEncoder &encoder)
{
    coder_.set_encoder(encoder);
}

bool FocusEngine::compute(const StackView &stack, const DepthOutputs &outputs)
{
    cl_ushort first = DepthScale::no_value;
    cl_float residual = 0.0f;
    translate_errors(*device_, [&] {
        const cl::Buffer depth = depth_for(outputs.depth);
        stack_.assign(stack);
        method_->run(stack_, coder_,
                     {.sparse = outputs.sparse.pixels != nullptr,
                      .confidence = outputs.confidence.pixels != nullptr,
                      .motion = outputs.motion.pixels != nullptr,
                      .uncertainty = outputs.uncertainty.pixels != nullptr},
                     depth);
        if (depth() == depth_())
            read(depth, sizeof(cl_ushort), outputs.depth);
        if (outputs.sparse.pixels)
            read(method_->sparse(), sizeof(cl_ushort), outputs.sparse);
        if (outputs.confidence.pixels)
            read(method_->confidence(), sizeof(cl_uchar), outputs.confidence);
        if (outputs.motion.pixels)
            read(method_->motion(), sizeof(cl_uchar), outputs.motion);
        if (outputs.uncertainty.pixels && method_->uncertainty())
            read(*method_->uncertainty(), sizeof(cl_ushort), outputs.uncertainty);
        else if (outputs.uncertainty.pixels)
            blank(outputs.uncertainty);
        queue_.commands().enqueueReadBuffer(depth, CL_FALSE, 0, sizeof first, &first);
        if (method_->residual())
            queue_.commands().enqueueReadBuffer(*method_->residual(), CL_FALSE, 0, sizeof residual,
                                                &residual);
        times_ = queue_.finish();
        stack_.remember(stack);
    });
    residual_ = method_->residual() ? std::optional(residual) : std::nullopt;
    return first != DepthScale::no_value;
}

/* The output itself where the device can write it: on a CPU, without padding between rows. */
cl::Buffer FocusEngine::depth_for(const OutputPicture &output)
{
    const size_t row_bytes = shape_.width * sizeof(cl_ushort), bytes = row_bytes * shape_.height;
    if (device_->works_in_place() && output.pixels && output.stride == row_bytes)
        return {device_->context(), CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, output.pixels};
    if (!depth_())
        depth_ = queue_.allocate(bytes);
    return depth_;
}

/* A map that the method does not tell. */
void FocusEngine::blank(const OutputPicture &output) const
{
    for (uint32_t y = 0; y < shape_.height; y++)
        std::memset(output.pixels + y * output.stride, 0, shape_.width * sizeof(cl_ushort));
}

void FocusEngine::read(const cl::Buffer &picture, size_t pixel_bytes, const OutputPicture &output)
{
    if (!output.pixels)
        return;
    const size_t row_bytes = shape_.width * pixel_bytes;
    queue_.commands().enqueueReadBufferRect(picture, CL_FALSE, {0, 0, 0}, {0, 0, 0},
                                            {row_bytes, shape_.height, 1}, row_bytes, 0, output.stride, 0,
                                            output.pixels);
}

} // namespace dff
