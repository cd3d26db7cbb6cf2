/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/aif_composer.h"

#include "engine/opencl/program.h"

#include <cmath>

namespace dff {

namespace {

constexpr double fixed_unit = 256.0;           /* UNIT of aif_rows.cl */
constexpr cl_ushort no_fixed_position = 65535; /* NO_POSITION */

cl_int2 size_of(const StackShape &shape)
{
    return {{static_cast<cl_int>(shape.width), static_cast<cl_int>(shape.height)}};
}

} // namespace

AifComposer::AifComposer(std::shared_ptr<Device> device, const StackShape &shape)
    : device_(std::move(device)), shape_(shape), components_(shape.components()), queue_(device_),
      stack_(queue_, shape),
      in_tiles_(device_->kernel_style() == KernelStyle::Tiles && shape.format != PixelFormat::Gray16),
      noise_(queue_, shape, 2),
      nearest_(queue_.allocate(size_t{shape.width} * shape.height * sizeof(cl_ushort))),
      softened_(queue_.allocate(size_t{shape.width} * shape.height * sizeof(cl_ushort))),
      positions_(queue_.allocate((DepthScale::max_pixel + 1) * sizeof(cl_float))),
      encoder_(DepthEncoder::index(shape.planes))
{
    const char *sample = shape.format == PixelFormat::Gray16 ? "-DSAMPLE=ushort" : "-DSAMPLE=uchar";
    compose_ = in_tiles_ ? Program(*device_, "aif_rows").kernel("compose_rows")
                         : Program(*device_, "aif", sample).kernel("compose");
    const Program softening(*device_, "soften_depth");
    nearest_pixel_ = softening.kernel("nearest_pixel");
    mean_pixel_ = softening.kernel("mean_pixel");
    set_encoder(encoder_);
}

void AifComposer::set_encoder(const DepthEncoder &encoder)
{
    if (in_tiles_)
        write_fixed_positions(encoder);
    else
        write_positions(encoder);
    encoder_ = encoder;
    if (sharp_)
        sharp_->set_encoder(encoder);
}

void AifComposer::write_positions(const DepthEncoder &encoder)
{
    std::vector<cl_float> positions(DepthScale::max_pixel + 1);
    for (unsigned pixel = 0; pixel < positions.size(); pixel++)
        positions[pixel] = static_cast<cl_float>(encoder.decode(static_cast<uint16_t>(pixel)).value_or(-1.0));
    queue_.commands().enqueueWriteBuffer(positions_, CL_TRUE, 0, positions.size() * sizeof(cl_float),
                                         positions.data());
}

void AifComposer::write_fixed_positions(const DepthEncoder &encoder)
{
    const double scale = fixed_unit * (shape_.planes - 1) / (DepthScale::max_pixel - 1);
    std::vector<cl_ushort> positions(DepthScale::max_pixel + 1, no_fixed_position);
    bool is_linear = true;
    for (unsigned pixel = 1; pixel < positions.size(); pixel++) {
        const std::optional<double> position = encoder.decode(static_cast<uint16_t>(pixel));
        if (position)
            positions[pixel] = static_cast<cl_ushort>(std::lround(fixed_unit * *position));
        is_linear = is_linear && position && std::abs(fixed_unit * *position - scale * (pixel - 1)) < 0.01;
    }
    position_scale_ = is_linear ? static_cast<float>(scale) : 0.0f;
    queue_.commands().enqueueWriteBuffer(positions_, CL_TRUE, 0, positions.size() * sizeof(cl_ushort),
                                         positions.data());
}

void AifComposer::compose(const StackView &stack, const DepthView &depth, Blend blend,
                          std::span<std::byte> picture, std::span<const RowLayout> layout)
{
    translate_errors(*device_, [&] {
        const cl_mem_flags placement = device_->is_cpu() ? CL_MEM_USE_HOST_PTR : CL_MEM_COPY_HOST_PTR;
        auto *depth_memory =
            const_cast<std::byte *>(depth.memory.data()); /* only read, as CL_MEM_READ_ONLY says */
        const Pictures pictures{
            {device_->context(), CL_MEM_READ_ONLY | placement, depth.memory.size(), depth_memory},
            {device_->context(), CL_MEM_READ_WRITE | placement, picture.size(), picture.data()},
            depth.stride / sizeof(cl_ushort)};
        const Pictures softened{softened_, pictures.output, shape_.width};

        stack_.assign(stack);
        if (blend == Blend::Sharp) {
            if (!sharp_)
                sharp_.emplace(queue_, shape_, encoder_);
            sharp_->measure(stack_);
        } else {
            soften(pictures);
        }
        if (blend == Blend::Soft)
            noise_.run(stack_);
        queue_.begin_stage("compose");
        for (size_t c = 0; c < components_.size(); c++)
            if (blend == Blend::Sharp)
                sharp_->compose(stack_, c, pictures.depth, pictures.depth_stride, pictures.output, layout[c]);
            else if (in_tiles_)
                compose_rows(softened, c, layout[c], blend);
            else
                compose_pixels(softened, c, layout[c], blend);
        if (!device_->is_cpu())
            queue_.commands().enqueueReadBuffer(pictures.output, CL_FALSE, 0, picture.size(), picture.data());
        times_ = queue_.finish();
    });
}

void AifComposer::soften(const Pictures &pictures)
{
    const auto width = static_cast<cl_int>(shape_.width), stride = static_cast<cl_int>(pictures.depth_stride);
    queue_.begin_stage("soften-depth");
    queue_.run(nearest_pixel_, {1, shape_.height}, pictures.depth, nearest_, width, stride);
    queue_.run(mean_pixel_, {1, shape_.height}, pictures.depth, nearest_, softened_, width, stride);
}

void AifComposer::compose_pixels(const Pictures &pictures, size_t component, const RowLayout &rows,
                                 Blend blend)
{
    const Component &c = components_[component];
    const cl_int2 component_size{{static_cast<cl_int>(c.width), static_cast<cl_int>(c.height)}};
    queue_.run(compose_, {c.width, c.height}, stack_.bytes(), stack_.layout(),
               static_cast<cl_int>(component * shape_.planes), pictures.depth, positions_, pictures.output,
               cl_ulong2{{rows.offset, rows.stride}}, component_size, static_cast<cl_int>(c.channels),
               static_cast<cl_int>(c.subsampling), size_of(shape_),
               static_cast<cl_int>(pictures.depth_stride), static_cast<cl_int>(shape_.planes),
               blend == Blend::Soft ? noise_.noise() : cl::Buffer());
}

void AifComposer::compose_rows(const Pictures &pictures, size_t component, const RowLayout &rows, Blend blend)
{
    const Component &c = components_[component];
    queue_.run_groups(
        compose_, {c.height}, stack_.bytes(), stack_.layout(), static_cast<cl_int>(component * shape_.planes),
        pictures.depth, positions_, position_scale_, pictures.output, cl_ulong2{{rows.offset, rows.stride}},
        static_cast<cl_int>(c.width), static_cast<cl_int>(c.channels), static_cast<cl_int>(c.subsampling),
        size_of(shape_), static_cast<cl_int>(pictures.depth_stride), static_cast<cl_int>(shape_.planes),
        blend == Blend::Soft ? noise_.noise() : cl::Buffer());
}

} // namespace dff
