/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/sharp_blend.h"

namespace dff {

namespace {

cl_int2 pixels_of(const Component &component)
{
    return {
        {static_cast<cl_int>(component.width / component.channels), static_cast<cl_int>(component.height)}};
}

} // namespace

SharpBlend::SharpBlend(CommandQueue &queue, const StackShape &shape, const DepthEncoder &encoder)
    : queue_(queue), shape_(shape), shapes_(shape.width, shape.height),
      weights_(queue, shape, shapes_, encoder)
{
    for (const Component &component : shape.components())
        pyramids_.push_back(make_pyramid(component, pyramids_.size()));
}

SharpBlend::Pyramid SharpBlend::make_pyramid(const Component &component, size_t index)
{
    Pyramid pyramid{component,
                    static_cast<cl_int>(index * shape_.planes),
                    component.subsampling == 2 ? size_t{1} : 0,
                    {},
                    {},
                    {},
                    {},
                    {},
                    {},
                    {}};
    const Program program(queue_.device(), "sharp_blend",
                          "-DSAMPLE_BYTES=" + std::to_string(component.sample_bytes) +
                              " -DCHANNELS=" + std::to_string(component.channels));
    pyramid.shrink_samples = program.kernel("shrink_samples");
    pyramid.shrink = program.kernel("shrink");
    pyramid.blend_top = program.kernel("blend_top");
    pyramid.blend = program.kernel("blend");
    pyramid.blend_samples = program.kernel("blend_samples");
    for (size_t l = pyramid.first + 1; l <= PyramidShape::top; l++) {
        const size_t cells = shapes_.levels[l].cells() * component.channels;
        pyramid.planes[l] = queue_.allocate(cells * shape_.planes * sizeof(cl_ushort));
        pyramid.result[l] = queue_.allocate(cells * sizeof(cl_float));
    }
    return pyramid;
}

void SharpBlend::run(const StackBuffer &stack, const cl::Buffer &depth, size_t depth_stride,
                     const cl::Buffer &picture, std::span<const RowLayout> layout)
{
    weights_.run(stack, depth, depth_stride);
    queue_.begin_stage("bands");
    for (Pyramid &pyramid : pyramids_)
        shrink(pyramid, stack);
    queue_.begin_stage("compose");
    for (size_t c = 0; c < pyramids_.size(); c++)
        blend(pyramids_[c], stack, picture, layout[c]);
}

void SharpBlend::shrink(Pyramid &pyramid, const StackBuffer &stack)
{
    const auto &levels = shapes_.levels;
    const size_t first = pyramid.first + 1, pictures = size_t{pyramid.component.channels} * shape_.planes;
    queue_.run(pyramid.shrink_samples, levels[first].blocks(shape_.planes), stack.bytes(), stack.layout(),
               pyramid.first_row, pixels_of(pyramid.component), pyramid.planes[first], levels[first],
               static_cast<cl_int>(shape_.planes));
    for (size_t l = first + 1; l <= PyramidShape::top; l++)
        queue_.run(pyramid.shrink, levels[l].blocks(pictures), pyramid.planes[l - 1], levels[l - 1],
                   pyramid.planes[l], levels[l]);
}

void SharpBlend::blend(Pyramid &pyramid, const StackBuffer &stack, const cl::Buffer &picture,
                       const RowLayout &layout)
{
    constexpr size_t top = PyramidShape::top;
    const auto &levels = shapes_.levels;
    const size_t first = pyramid.first + 1, channels = pyramid.component.channels;
    const auto planes = static_cast<cl_int>(shape_.planes);
    queue_.run(pyramid.blend_top, levels[top].blocks(channels), pyramid.planes[top], weights_.of_level(top),
               levels[top], planes, pyramid.result[top]);
    for (size_t l = top - 1; l >= first; l--)
        queue_.run(pyramid.blend, levels[l].blocks(channels), pyramid.planes[l], weights_.of_level(l),
                   levels[l], pyramid.planes[l + 1], pyramid.result[l + 1], levels[l + 1], planes,
                   pyramid.result[l]);
    queue_.run(pyramid.blend_samples, levels[pyramid.first].blocks(), stack.bytes(), stack.layout(),
               pyramid.first_row, pixels_of(pyramid.component), weights_.of_level(pyramid.first), levels[1],
               static_cast<cl_int>(pyramid.component.subsampling), pyramid.planes[first],
               pyramid.result[first], levels[first], planes, picture,
               cl_ulong2{{layout.offset, layout.stride}});
}

} // namespace dff
