/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/light_field_layers.h"

#include "engine/opencl/program.h"

#include <algorithm>
#include <cmath>

namespace dff {

namespace {

constexpr size_t strips = 64;                   /* of light_field_shrink.cl */
constexpr size_t read_behind = 3;               /* pixels, by light_field_row.cl and light_field_rays.cl */
constexpr size_t block = 16, group = 4 * block; /* pixels a side, of light_field_roof.cl */

float step_of(const LightFieldGeometry &geometry)
{
    return static_cast<float>(LightFieldLayers::edge_step * geometry.range);
}

int reach_of(const LightFieldGeometry &geometry)
{
    return static_cast<int>(std::ceil(geometry.reach * geometry.range)) + 1;
}

/* The first column of the layers that is needed, and the one behind the last: what rays meet, beside it the
 * ground that is hidden, and beside that what it is continued with. */
cl_int2 columns_of(const LightFieldGeometry &geometry)
{
    const auto [first, count] = geometry.columns();
    const int beside = 2 * reach_of(geometry);
    return {{std::clamp(first - beside, 0, geometry.layers.x - 1),
             std::clamp(first + count + beside, 1, geometry.layers.x)}};
}

/* Columns and rows of squares with this side. */
std::pair<size_t, size_t> squares(glm::ivec2 size, size_t side)
{
    return {(static_cast<size_t>(size.x) + side - 1) / side, (static_cast<size_t>(size.y) + side - 1) / side};
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

LightFieldLayers::LightFieldLayers(CommandQueue &queue, glm::ivec2 size, PictureSize source)
    : queue_(queue), size_(size), in_rows_(queue.device().kernel_style() == KernelStyle::Tiles),
      sums_size_(static_cast<cl_int>((4 * source.width + 31) / 16 * 16))
{
    const Program program(queue.device(), "light_field_layers");
    if (in_rows_) {
        shrink_color_ = Program(queue.device(), "light_field_shrink").kernel("shrink_color_rows");
        sums_ = queue.allocate(strips * sizeof(cl_float) * static_cast<size_t>(sums_size_));
    } else {
        shrink_color_ = program.kernel("shrink_color");
    }
    height_of_depth_ = program.kernel("height_of_depth");
    fill_unknown_ = program.kernel("fill_unknown");
    hide_ = program.kernel("hide");
    const Program roof(queue.device(), "light_field_roof");
    raise_roof_ = roof.kernel("raise_roof");
    join_roof_ = roof.kernel("join_roof");
    const size_t pixels = static_cast<size_t>(size.x) * static_cast<size_t>(size.y);
    for (cl::Buffer *buffer : {&color_, &height_, &hidden_color_, &hidden_height_, &grounds_})
        *buffer = queue.allocate(4 * (pixels + read_behind));
    const auto [blocks, block_rows] = squares(size, block);
    const auto [groups, group_rows] = squares(size, group);
    roof_ = queue.allocate((blocks * block_rows + groups * group_rows) * sizeof(cl_float));
}

void LightFieldLayers::shrink_color(const ColorAndDepth &pictures, cl_int2 columns)
{
    const cl_int2 source = to_int2({pictures.size.width, pictures.size.height}), size = to_int2(size_);
    if (in_rows_)
        queue_.run_groups(shrink_color_, cl::NDRange(strips), pictures.color, pictures.color_stride,
                          pictures.channels, source, color_, size, columns, sums_, sums_size_);
    else
        queue_.run(shrink_color_,
                   {static_cast<size_t>(columns.s[1] - columns.s[0]), static_cast<size_t>(size_.y)},
                   pictures.color, pictures.color_stride, pictures.channels, source, color_, size, columns);
}

void LightFieldLayers::run(const ColorAndDepth &pictures, const cl::Buffer &positions,
                           const LightFieldGeometry &geometry)
{
    const cl_int2 source = to_int2({pictures.size.width, pictures.size.height}), size = to_int2(size_);
    const cl_int2 columns = columns_of(geometry);
    const cl::NDRange pixels(static_cast<size_t>(columns.s[1] - columns.s[0]), static_cast<size_t>(size_.y));
    const cl::NDRange rows(static_cast<size_t>(size_.y));
    const auto zero = static_cast<cl_float>(1.0 + geometry.lowest / geometry.range);

    queue_.begin_stage("colour");
    shrink_color(pictures, columns);
    queue_.begin_stage("heights");
    queue_.run(height_of_depth_, pixels, pictures.depth, pictures.depth_stride, positions, source, height_,
               size, columns, zero, static_cast<cl_float>(geometry.range));
    queue_.run_groups(fill_unknown_, rows, height_, size_.x, columns);
    queue_.begin_stage("hidden");
    queue_.run_groups(hide_, rows, color_, height_, hidden_color_, hidden_height_, grounds_, size_.x, columns,
                      step_of(geometry), reach_of(geometry));
}

void LightFieldLayers::raise_roof(const LightFieldGeometry &geometry)
{
    const auto [blocks, block_rows] = squares(size_, block);
    const auto [groups, group_rows] = squares(size_, group);
    queue_.begin_stage("roof");
    queue_.run(raise_roof_, {blocks, block_rows}, height_, to_int2(size_), columns_of(geometry), roof_);
    queue_.run(join_roof_, {groups, group_rows}, to_int2(size_), roof_);
}

cl_uint LightFieldLayers::set_arguments(cl::Kernel &kernel, const LightFieldGeometry &geometry,
                                        bool fill) const
{
    const cl_float2 heights = to_float2({geometry.lowest, geometry.lowest + geometry.range});
    cl_uint index = 0;
    for (const cl::Buffer *buffer : {&color_, &height_, &hidden_color_, &hidden_height_, &roof_})
        kernel.setArg(index++, *buffer);
    kernel.setArg(index++, to_int2(size_));
    kernel.setArg(index++, heights);
    kernel.setArg(index++, step_of(geometry));
    kernel.setArg(index++, static_cast<cl_int>(fill));
    return index;
}

} // namespace dff
