/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/aif_composer.h"

namespace dff {

AifComposer::AifComposer(std::shared_ptr<Device> device, const StackShape &shape)
    : device_(std::move(device)), shape_(shape), queue_(device_), stack_(queue_, shape),
      positions_(queue_.allocate((DepthScale::max_pixel + 1) * sizeof(cl_float)))
{
    const char *sample = shape.format == PixelFormat::Gray16 ? "-DSAMPLE=ushort" : "-DSAMPLE=uchar";
    compose_ = Program(*device_, "aif", sample).kernel("compose");
    set_encoder(DepthEncoder::index(shape.planes));
}

void AifComposer::set_encoder(const DepthEncoder &encoder)
{
    std::vector<cl_float> positions(DepthScale::max_pixel + 1);
    for (unsigned pixel = 0; pixel < positions.size(); pixel++)
        positions[pixel] = static_cast<cl_float>(encoder.decode(static_cast<uint16_t>(pixel)).value_or(-1.0));
    queue_.commands().enqueueWriteBuffer(positions_, CL_TRUE, 0, positions.size() * sizeof(cl_float),
                                         positions.data());
}

void AifComposer::compose(const StackView &stack, const DepthView &depth, Blend blend,
                          std::span<std::byte> picture, std::span<const RowLayout> layout)
{
    translate_errors(*device_, [&] {
        const cl_mem_flags placement = device_->is_cpu() ? CL_MEM_USE_HOST_PTR : CL_MEM_COPY_HOST_PTR;
        auto *depth_memory =
            const_cast<std::byte *>(depth.memory.data()); /* only read, as CL_MEM_READ_ONLY says */
        const cl::Buffer depth_buffer(device_->context(), CL_MEM_READ_ONLY | placement, depth.memory.size(),
                                      depth_memory);
        const cl::Buffer output(device_->context(), CL_MEM_READ_WRITE | placement, picture.size(),
                                picture.data());
        const std::vector<Component> components = shape_.components();
        const cl_int2 depth_size{{static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.height)}};

        stack_.assign(stack);
        queue_.begin_stage("compose");
        for (size_t c = 0; c < components.size(); c++) {
            const cl_ulong2 picture_rows{{layout[c].offset, layout[c].stride}};
            const cl_int2 size{
                {static_cast<cl_int>(components[c].width), static_cast<cl_int>(components[c].height)}};
            queue_.run(compose_, {components[c].width, components[c].height}, stack_.bytes(), stack_.layout(),
                       static_cast<cl_int>(c * shape_.planes), depth_buffer, positions_, output, picture_rows,
                       size, static_cast<cl_int>(components[c].channels),
                       static_cast<cl_int>(components[c].subsampling), depth_size,
                       static_cast<cl_int>(depth.stride / sizeof(cl_ushort)),
                       static_cast<cl_int>(shape_.planes), static_cast<cl_int>(blend == Blend::Soft));
        }
        if (!device_->is_cpu())
            queue_.commands().enqueueReadBuffer(output, CL_FALSE, 0, picture.size(), picture.data());
        times_ = queue_.finish();
    });
}

} // namespace dff
