/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/aif_composer.h"

#include "engine/engine_error.h"
#include "engine/opencl/program.h"

#include <algorithm>
#include <cmath>

namespace dff {

namespace {

/* aif_strips.cl */
constexpr double fixed_unit = 256.0; /* UNIT */
constexpr size_t strip = 16;
constexpr uint32_t usual_columns = 8192, most_columns = 16384; /* MOST_COLUMNS */
constexpr cl_ushort no_fixed_position = 65535;                 /* NO_POSITION */

/* Component of aif_strips.cl. */
struct PictureComponent {
    cl_ulong offset, stride;
    cl_int first_row, width, height, channels, subsampling;
};

cl_int2 size_of(const StackShape &shape)
{
    return {{static_cast<cl_int>(shape.width), static_cast<cl_int>(shape.height)}};
}

} // namespace

AifComposer::AifComposer(std::shared_ptr<Device> device, const StackShape &shape)
    : device_(std::move(device)), shape_(shape), components_(shape.components()), queue_(device_),
      stack_(queue_, shape), depth_(queue_), picture_(queue_),
      in_strips_(device_->kernel_style() == KernelStyle::Tiles && sample_bytes(shape.format) == 1 &&
                 shape.width <= most_columns),
      noise_(queue_, shape, 2), positions_(queue_.allocate((DepthScale::max_pixel + 1) * sizeof(cl_float))),
      encoder_(DepthEncoder::index(shape.planes))
{
    const char *sample = sample_bytes(shape.format) == 2 ? "-DSAMPLE=ushort" : "-DSAMPLE=uchar";
    if (in_strips_) {
        const uint32_t columns = shape.width <= usual_columns ? usual_columns : most_columns;
        compose_ = Program(*device_, "aif_strips", "-DMOST_COLUMNS=" + std::to_string(columns))
                       .kernel("compose_strip");
        picture_components_ = queue_.allocate(components_.size() * sizeof(PictureComponent));
    } else {
        compose_ = Program(*device_, "aif", sample).kernel("compose");
        const Program softening(*device_, "soften_depth");
        nearest_pixel_ = softening.kernel("nearest_pixel");
        mean_pixel_ = softening.kernel("mean_pixel");
        const size_t depth_bytes = size_t{shape.width} * shape.height * sizeof(cl_ushort);
        nearest_ = queue_.allocate(depth_bytes);
        softened_ = queue_.allocate(depth_bytes);
    }
    set_encoder(encoder_);
}

void AifComposer::set_encoder(const DepthEncoder &encoder)
{
    if (in_strips_)
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
    bool fits = layout.size() == components_.size() &&
                lies_within({shape_.width, shape_.height, 1, 1, sizeof(cl_ushort)}, {0, depth.stride},
                            depth.memory.size());
    for (size_t c = 0; fits && c < components_.size(); c++)
        fits = lies_within(components_[c], layout[c], picture.size());
    if (!fits)
        throw EngineError(EngineError::Kind::Failed,
                          "The depth map or the picture does not have the stack's size");
    translate_errors(*device_, [&] {
        Pictures pictures{depth_.upload(depth.memory), picture_.target(picture),
                          depth.stride / sizeof(cl_ushort)};
        stack_.assign(stack);
        limit_depth(pictures, depth.blur_step);
        if (blend != Blend::Sharp)
            noise_.run(stack_);
        if (blend == Blend::Sharp)
            compose_sharp(pictures, layout);
        else if (in_strips_)
            compose_strips(pictures, layout, blend);
        else
            compose_pixels(pictures, layout, blend);
        picture_.download(picture);
        times_ = queue_.finish();
    });
}

void AifComposer::limit_depth(Pictures &pictures, float blur_step)
{
    if (!DepthReach::is_needed(blur_step))
        return;
    if (!reach_)
        reach_.emplace(queue_, shape_);
    pictures.depth = reach_->run(pictures.depth, pictures.depth_stride, blur_step);
    pictures.depth_stride = shape_.width;
}

void AifComposer::compose_sharp(const Pictures &pictures, std::span<const RowLayout> layout)
{
    if (!sharp_)
        sharp_.emplace(queue_, shape_, encoder_);
    sharp_->run(stack_, pictures.depth, pictures.depth_stride, pictures.output, layout);
}

void AifComposer::compose_pixels(const Pictures &pictures, std::span<const RowLayout> layout, Blend blend)
{
    const auto width = static_cast<cl_int>(shape_.width), stride = static_cast<cl_int>(pictures.depth_stride);
    queue_.begin_stage("soften-depth");
    queue_.run(nearest_pixel_, {1, shape_.height}, pictures.depth, nearest_, width, stride);
    queue_.run(mean_pixel_, {1, shape_.height}, pictures.depth, nearest_, softened_, width, stride);

    queue_.begin_stage("compose");
    for (size_t i = 0; i < components_.size(); i++) {
        const Component &c = components_[i];
        const cl_int2 component_size{{static_cast<cl_int>(c.width), static_cast<cl_int>(c.height)}};
        queue_.run(compose_, {c.width, c.height}, stack_.bytes(), stack_.layout(),
                   static_cast<cl_int>(i * shape_.planes), softened_, positions_, pictures.output,
                   cl_ulong2{{layout[i].offset, layout[i].stride}}, component_size,
                   static_cast<cl_int>(c.channels), static_cast<cl_int>(c.subsampling), size_of(shape_),
                   width, static_cast<cl_int>(shape_.planes), noise_.noise(), cl_int{blend == Blend::Soft});
    }
}

void AifComposer::compose_strips(const Pictures &pictures, std::span<const RowLayout> layout, Blend blend)
{
    if (!std::equal(layout.begin(), layout.end(), picture_layout_.begin(), picture_layout_.end())) {
        std::vector<PictureComponent> table;
        for (size_t i = 0; i < components_.size(); i++) {
            const Component &c = components_[i];
            table.push_back({layout[i].offset, layout[i].stride, static_cast<cl_int>(i * shape_.planes),
                             static_cast<cl_int>(c.width), static_cast<cl_int>(c.height),
                             static_cast<cl_int>(c.channels), static_cast<cl_int>(c.subsampling)});
        }
        queue_.commands().enqueueWriteBuffer(picture_components_, CL_TRUE, 0,
                                             table.size() * sizeof(PictureComponent), table.data());
        picture_layout_.assign(layout.begin(), layout.end());
    }
    queue_.begin_stage("compose");
    queue_.run_groups(compose_, {(shape_.height + strip - 1) / strip}, stack_.bytes(), stack_.layout(),
                      pictures.depth, size_of(shape_), static_cast<cl_int>(pictures.depth_stride), positions_,
                      position_scale_, pictures.output, picture_components_,
                      static_cast<cl_int>(components_.size()), static_cast<cl_int>(shape_.planes),
                      noise_.noise(), cl_int{blend == Blend::Soft});
}

} // namespace dff
