/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/light_field_renderer.h"

#include "engine/opencl/program.h"
#include "optics/depth_scale.h"

#include <glm/matrix.hpp>
#include <limits>
#include <vector>

namespace dff {

namespace {

bool is_blue_first(PixelFormat format)
{
    return format == PixelFormat::Bgr || format == PixelFormat::Bgrx;
}

cl_int channels_of(PixelFormat format)
{
    return format == PixelFormat::Rgb || format == PixelFormat::Bgr ? 3 : 4;
}

/* light_field_row.cl and light_field_lenses.cl */
constexpr unsigned strips = 64;
constexpr unsigned sectors = 4; /* from the middle of the cone to its edge */

constexpr unsigned pitch_of(unsigned width)
{
    return (width + 31) / 16 * 16;
}

/* Whether a work-item renders rows. */
bool in_rows(const Device &device, LightFieldLayout layout)
{
    return device.kernel_style() == KernelStyle::Tiles && layout != LightFieldLayout::Rgbd;
}

/* Whether rays are followed to where they meet the relief; else that is found without a search. */
bool follows_rays(const Device &device, LightFieldLayout layout)
{
    return !in_rows(device, layout) || layout == LightFieldLayout::Elemental;
}

cl::Kernel kernel_of(const Device &device, LightFieldLayout layout)
{
    switch (layout) {
    case LightFieldLayout::Rgbd:
        return Program(device, "light_field_rgbd").kernel("place_depth");
    case LightFieldLayout::Lenticular:
        return in_rows(device, layout) ? Program(device, "light_field_lenses").kernel("lenticular_rows")
                                       : Program(device, "light_field_panel").kernel("lenticular");
    case LightFieldLayout::Elemental:
        return in_rows(device, layout) ? Program(device, "light_field_rays").kernel("elemental_rows")
                                       : Program(device, "light_field_panel").kernel("elemental");
    default:
        return in_rows(device, layout) ? Program(device, "light_field_rows").kernel("view_rows")
                                       : Program(device, "light_field_views").kernel("views");
    }
}

/* The rows of a matrix, as elemental takes it. */
cl_float4 rows_of(const glm::dmat2 &m)
{
    return {{static_cast<cl_float>(m[0][0]), static_cast<cl_float>(m[1][0]), static_cast<cl_float>(m[0][1]),
             static_cast<cl_float>(m[1][1])}};
}

/* The slopes of the views, row by row from the bottom. */
std::vector<cl_float> slopes_of(const LightFieldParameters &parameters)
{
    const unsigned columns = parameters.columns, rows = parameters.rows;
    std::vector<cl_float> slopes;
    for (unsigned i = 0; i < columns * rows; i++) {
        const bool from_top = parameters.layout == LightFieldLayout::Views;
        const unsigned view = from_top ? (rows - 1 - i / columns) * columns + i % columns : i;
        slopes.push_back(static_cast<cl_float>(view_slope(view, columns * rows, parameters.view_cone)));
    }
    return slopes;
}

/* What lenticular kernels take for `shifts`. */
std::vector<cl_float> shifts_of(const LightFieldShape &shape, const LenticularSheet &sheet)
{
    std::vector<cl_float> shifts;
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 2; x++)
            for (unsigned byte = 0; byte < 3; byte++)
                shifts.push_back(static_cast<cl_float>(subpixel_shift(
                    sheet, {x, y}, is_blue_first(shape.format) ? 2 - byte : byte, shape.output)));
    return shifts;
}

std::vector<float> index_positions()
{
    std::vector<float> positions(DepthScale::max_pixel + 1);
    for (size_t pixel = 0; pixel < positions.size(); pixel++)
        positions[pixel] = (static_cast<float>(pixel) - 1.0F) / static_cast<float>(DepthScale::max_pixel - 1);
    positions[DepthScale::no_value] = std::numeric_limits<float>::quiet_NaN();
    return positions;
}

} // namespace

LightFieldRenderer::LightFieldRenderer(std::shared_ptr<Device> device, const LightFieldShape &shape,
                                       const LightFieldParameters &parameters)
    : device_(std::move(device)), shape_(shape), parameters_(parameters),
      geometry_(parameters, shape.picture, shape.output), queue_(device_),
      positions_(queue_.allocate((DepthScale::max_pixel + 1) * sizeof(cl_float)))
{
    set_positions(index_positions());
    set_parameters(parameters);
}

void LightFieldRenderer::set_positions(std::span<const float> positions)
{
    translate_errors(*device_, [&] {
        queue_.commands().enqueueWriteBuffer(positions_, CL_TRUE, 0, positions.size_bytes(),
                                             positions.data());
    });
}

void LightFieldRenderer::set_parameters(const LightFieldParameters &parameters)
{
    parameters_ = parameters;
    geometry_ = LightFieldGeometry(parameters, shape_.picture, shape_.output);
    translate_errors(*device_, [&] {
        if (built_ != parameters.layout && parameters.layout == LightFieldLayout::Rgbd)
            place_color_ = Program(*device_, "light_field_rgbd").kernel("place_color");
        if (built_ != parameters.layout)
            kernel_ = kernel_of(*device_, parameters.layout);
        built_ = parameters.layout;
        if (parameters.layout == LightFieldLayout::Rgbd)
            return;
        if (!layers_ || layers_->size() != geometry_.layers)
            layers_.emplace(queue_, geometry_.layers, shape_.picture);
        slopes_ = upload(slopes_of(parameters));
        shifts_ = upload(shifts_of(shape_, parameters.sheet));
        if (!follows_rays(*device_, parameters.layout))
            prepare_rows();
    });
}

cl::Buffer LightFieldRenderer::upload(const std::vector<cl_float> &values)
{
    const size_t bytes = values.size() * sizeof(cl_float);
    cl::Buffer buffer = queue_.allocate(bytes);
    queue_.commands().enqueueWriteBuffer(buffer, CL_TRUE, 0, bytes, values.data());
    return buffer;
}

void LightFieldRenderer::prepare_rows()
{
    columns_ = geometry_.columns();
    const unsigned pitch = pitch_of(static_cast<unsigned>(columns_.count));
    const unsigned view_pitch = pitch_of(static_cast<unsigned>(geometry_.view.x));
    const bool lenticular = parameters_.layout == LightFieldLayout::Lenticular;
    scratch_size_ =
        static_cast<cl_int>(8 * pitch + (lenticular ? (2 * sectors + 7) * pitch : 2 * pitch + view_pitch));
    scratch_ = queue_.allocate(strips * sizeof(cl_uint) * static_cast<size_t>(scratch_size_));
}

cl::Buffer LightFieldRenderer::wrap(std::span<const std::byte> memory, cl_mem_flags access) const
{
    const cl_mem_flags placement = device_->works_in_place() ? CL_MEM_USE_HOST_PTR : CL_MEM_COPY_HOST_PTR;
    /* OpenCL has no buffers of const host memory; `access` keeps the promise. */
    return {device_->context(), access | placement, memory.size(), const_cast<std::byte *>(memory.data())};
}

void LightFieldRenderer::render(const Rows &color, const Rows &depth, std::span<std::byte> output,
                                size_t output_stride)
{
    translate_errors(*device_, [&] {
        const ColorAndDepth pictures{wrap(color.memory, CL_MEM_READ_ONLY),
                                     wrap(depth.memory, CL_MEM_READ_ONLY),
                                     color.stride,
                                     depth.stride,
                                     channels_of(shape_.format),
                                     shape_.picture};
        const Output target{wrap(output, CL_MEM_READ_WRITE), output_stride};
        if (parameters_.layout == LightFieldLayout::Rgbd) {
            copy_rgbd(pictures, target);
        } else {
            layers_->run(pictures, positions_, geometry_);
            if (follows_rays(*device_, parameters_.layout))
                layers_->raise_roof(geometry_);
            trace(target);
        }
        if (!device_->works_in_place())
            queue_.commands().enqueueReadBuffer(target.rows, CL_FALSE, 0, output.size(), output.data());
        times_ = queue_.finish();
    });
}

void LightFieldRenderer::trace(const Output &output)
{
    queue_.begin_stage("trace");
    const cl_uint index = layers_->set_arguments(kernel_, geometry_, parameters_.fill);
    if (parameters_.layout == LightFieldLayout::Lenticular)
        trace_lenticular(index, output);
    else if (parameters_.layout == LightFieldLayout::Elemental)
        trace_elemental(index, output);
    else
        trace_views(index, output);
    if (in_rows(*device_, parameters_.layout))
        queue_.run_groups(kernel_, cl::NDRange(strips));
    else
        queue_.run(kernel_, {shape_.output.width, shape_.output.height});
}

template <typename... Arguments>
void LightFieldRenderer::set_trace_arguments(cl_uint index, const Output &output,
                                             const Arguments &...arguments)
{
    const auto set = [&](const auto &...all) { (kernel_.setArg(index++, all), ...); };
    set(arguments...);
    set(to_float2(geometry_.first), to_float2(geometry_.scale), output.rows, output.stride,
        channels_of(shape_.format), to_int2({shape_.output.width, shape_.output.height}));
}

void LightFieldRenderer::trace_views(cl_uint index, const Output &output)
{
    const cl_int2 layout = to_int2({parameters_.columns, parameters_.rows});
    const cl_int2 view = to_int2(geometry_.view);
    if (in_rows(*device_, parameters_.layout))
        set_trace_arguments(index, output, slopes_, layout, view, columns_.first, columns_.count, scratch_,
                            scratch_size_);
    else
        set_trace_arguments(index, output, slopes_, layout, view);
}

void LightFieldRenderer::trace_lenticular(cl_uint index, const Output &output)
{
    const LenticularSheet &sheet = parameters_.sheet;
    const auto pitch = static_cast<cl_float>(sheet.pitch), tilt = static_cast<cl_float>(sheet.tilt),
               center = static_cast<cl_float>(sheet.center),
               cone = static_cast<cl_float>(parameters_.view_cone);
    const cl_int4 flips{{sheet.flip_x, sheet.flip_y, sheet.invert_view, 0}};
    if (in_rows(*device_, parameters_.layout))
        set_trace_arguments(index, output, pitch, tilt, center, cone, shifts_, flips, columns_.first,
                            columns_.count, scratch_, scratch_size_);
    else
        set_trace_arguments(index, output, pitch, tilt, center, cone, shifts_, flips);
}

void LightFieldRenderer::trace_elemental(cl_uint index, const Output &output)
{
    const LensArray &lenses = parameters_.lenses;
    const glm::dmat2 to_lens = to_lens_matrix(lenses);
    const glm::dvec2 middle(shape_.output.width / 2.0, shape_.output.height / 2.0);
    set_trace_arguments(index, output, to_float2(middle + lenses.center), rows_of(to_lens),
                        rows_of(glm::inverse(to_lens)), static_cast<cl_float>(lens_gap(parameters_)),
                        static_cast<cl_int>(lenses.grid == LensGrid::Hexagonal),
                        static_cast<cl_int>(lenses.flip));
}

void LightFieldRenderer::copy_rgbd(const ColorAndDepth &pictures, const Output &output)
{
    const DepthSide side = parameters_.depth_side;
    const PictureSize size = shape_.picture;
    const cl_int width = static_cast<cl_int>(size.width), channels = pictures.channels;
    const bool beside = side == DepthSide::Right || side == DepthSide::Left;
    const bool depth_first = side == DepthSide::Left || side == DepthSide::Above;
    const cl_ulong second =
        beside ? static_cast<cl_ulong>(channels) * size.width : output.stride * size.height;
    queue_.begin_stage("copy");
    queue_.run(place_color_, {size.width, size.height}, pictures.color, pictures.color_stride, width,
               output.rows, depth_first ? second : cl_ulong{0}, output.stride, channels);
    queue_.run(kernel_, {size.width, size.height}, pictures.depth, pictures.depth_stride, positions_, width,
               static_cast<cl_int>(parameters_.invert_depth), output.rows, depth_first ? cl_ulong{0} : second,
               output.stride, channels);
}

} // namespace dff
