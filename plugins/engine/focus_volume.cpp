/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/focus_volume.h"

#include "engine/luma.h"

namespace dff {

namespace {

constexpr cl_int strip = 8; /* low rows a work-item */

/* Luma of 8 bits is read where it lies; other formats are turned into thirds of a DN. */
bool has_byte_luma(PixelFormat format)
{
    return format == PixelFormat::Gray8 || format == PixelFormat::I420 || format == PixelFormat::Nv12;
}

std::string build_options(PixelFormat format, cl_int scale)
{
    std::string options = "-DSCALE=" + std::to_string(scale) + " -DSTRIP=" + std::to_string(strip);
    if (has_byte_luma(format))
        return options +
               " -DSAMPLE=uchar -DSAMPLES_ANYWHERE=uchar16_anywhere -DCOLUMN_SHIFT=4 -DSAMPLES_A_DN=1"
               " -DBLURRED_SAMPLES_A_DN=4";
    if (format == PixelFormat::Gray16)
        options += " -DGRAY16";
    return options + " -DSAMPLE=ushort -DSAMPLES_ANYWHERE=ushort16_anywhere -DCOLUMN_SHIFT=6 -DSAMPLES_A_DN=3"
                     " -DBLURRED_SAMPLES_A_DN=3";
}

} // namespace

FocusVolume::FocusVolume(CommandQueue &queue, const StackShape &shape, const LowShape &low)
    : queue_(queue), shape_(shape), low_(low), volume_(low.allocate(queue, shape.planes))
{
    const Program program(queue.device(), "focus_volume", build_options(shape.format, low.scale));
    thirds_ = program.kernel("thirds");
    blur_columns_ = program.kernel("blur_columns");
    blur_rows_ = program.kernel("blur_rows");
    focus_columns_ = program.kernel("focus_columns");
    focus_columns_blurred_ = program.kernel("focus_columns_blurred");
    focus_rows_ = program.kernel("focus_rows");

    const size_t samples = size_t{shape.width} * shape.height * shape.planes;
    half_blurred_ = queue.allocate(samples * sizeof(cl_ushort));
    blurred_ = queue.allocate(samples * sizeof(cl_ushort));
    columns_ = queue.allocate(size_t{shape.width} * low.height * shape.planes * sizeof(cl_ushort));
    if (has_byte_luma(shape.format))
        return;
    samples_ = queue.allocate(samples * sizeof(cl_ushort));
    const std::vector<RowLayout> rows =
        packed_layout({PixelFormat::Gray16, shape.width, shape.height, shape.planes});
    sample_rows_ = queue.allocate(rows.size() * sizeof(RowLayout));
    queue.commands().enqueueWriteBuffer(sample_rows_, CL_TRUE, 0, rows.size() * sizeof(RowLayout),
                                        rows.data());
}

void FocusVolume::run(const StackBuffer &stack, const NoiseEstimate &noise)
{
    const auto width = static_cast<cl_int>(shape_.width), height = static_cast<cl_int>(shape_.height);
    const cl::NDRange rows(1, shape_.height, shape_.planes);
    const cl::NDRange strips(1, static_cast<size_t>((low_.height + strip - 1) / strip), shape_.planes);

    queue_.begin_stage("focus-volume");
    if (has_byte_luma(shape_.format)) {
        samples_ = stack.bytes();
        sample_rows_ = stack.layout();
    } else {
        queue_.run(thirds_, rows, stack.bytes(), stack.layout(), samples_, width,
                   colour_channels(shape_.format));
    }
    queue_.run(blur_columns_, rows, samples_, sample_rows_, noise.noise(), half_blurred_, width);
    queue_.run(blur_rows_, rows, half_blurred_, noise.noise(), blurred_, width);
    queue_.run(focus_columns_, strips, samples_, sample_rows_, noise.noise(), columns_, width, height,
               low_.height);
    queue_.run(focus_columns_blurred_, strips, blurred_, noise.noise(), columns_, width, height, low_.height);
    queue_.run(focus_rows_, low_.rows_of_planes(), columns_, noise.noise(), volume_, width, low_.width,
               low_.stride);
}

} // namespace dff
