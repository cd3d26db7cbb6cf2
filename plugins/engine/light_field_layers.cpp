/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/light_field_layers.h"

#include "engine/opencl/program.h"

#include <cmath>

namespace dff {

namespace {

float step_of(const LightFieldGeometry &geometry)
{
    return static_cast<float>(LightFieldLayers::edge_step * geometry.range);
}

} // namespace

cl_float2 to_float2(glm::dvec2 vector)
{
    return {{static_cast<cl_float>(vector.x), static_cast<cl_float>(vector.y)}};
}

cl_int2 to_int2(glm::ivec2 vector)
{
    return {{vector.x, vector.y}};
}

LightFieldLayers::LightFieldLayers(CommandQueue &queue, glm::ivec2 size) : queue_(queue), size_(size)
{
    const Program program(queue.device(), "light_field_layers");
    shrink_color_ = program.kernel("shrink_color");
    height_of_depth_ = program.kernel("height_of_depth");
    fill_unknown_ = program.kernel("fill_unknown");
    hide_ = program.kernel("hide");
    const size_t pixels = static_cast<size_t>(size.x) * static_cast<size_t>(size.y);
    for (cl::Buffer *buffer : {&color_, &height_, &hidden_color_, &hidden_height_, &grounds_})
        *buffer = queue.allocate(4 * pixels);
}

void LightFieldLayers::run(const ColorAndDepth &pictures, const cl::Buffer &positions,
                           const LightFieldGeometry &geometry)
{
    const cl_int2 source = to_int2({pictures.size.width, pictures.size.height}), size = to_int2(size_);
    const cl::NDRange pixels(static_cast<size_t>(size_.x), static_cast<size_t>(size_.y));
    const cl::NDRange rows(static_cast<size_t>(size_.y));
    const auto zero = static_cast<cl_float>(1.0 + geometry.lowest / geometry.range);
    const auto reach = static_cast<cl_int>(std::ceil(geometry.reach * geometry.range)) + 1;

    queue_.begin_stage("colour");
    queue_.run(shrink_color_, pixels, pictures.color, pictures.color_stride, pictures.channels, source,
               color_, size);
    queue_.begin_stage("height");
    queue_.run(height_of_depth_, pixels, pictures.depth, pictures.depth_stride, positions, source, height_,
               size, zero, static_cast<cl_float>(geometry.range));
    queue_.run_groups(fill_unknown_, rows, height_, size_.x);
    queue_.begin_stage("hidden");
    queue_.run_groups(hide_, rows, color_, height_, hidden_color_, hidden_height_, grounds_, size_.x,
                      step_of(geometry), reach);
}

cl_uint LightFieldLayers::set_arguments(cl::Kernel &kernel, const LightFieldGeometry &geometry,
                                        bool fill) const
{
    const cl_float2 heights = to_float2({geometry.lowest, geometry.lowest + geometry.range});
    cl_uint index = 0;
    for (const cl::Buffer *buffer : {&color_, &height_, &hidden_color_, &hidden_height_})
        kernel.setArg(index++, *buffer);
    kernel.setArg(index++, to_int2(size_));
    kernel.setArg(index++, heights);
    kernel.setArg(index++, step_of(geometry));
    kernel.setArg(index++, static_cast<cl_int>(fill));
    return index;
}

} // namespace dff
