/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/focus_volume.h"

#include "engine/luma.h"

namespace dff {

namespace {

/* Luma of 8 bits is read where it lies; other formats are turned into thirds of a DN. */
bool has_byte_luma(PixelFormat format)
{
    return format == PixelFormat::Gray8 || format == PixelFormat::I420 || format == PixelFormat::Nv12;
}

std::string build_options(PixelFormat format, const LowShape &low)
{
    const std::string options = colour_options(format) + " -DSCALE=" + std::to_string(low.scale);
    return has_byte_luma(format) ? options : options + " -DTHIRDS";
}

} // namespace

FocusVolume::FocusVolume(CommandQueue &queue, const StackShape &shape, const LowShape &low)
    : queue_(queue), shape_(shape), low_(low), scratch_(queue.allocate(scratch_bytes(shape, low))),
      volume_(low.allocate_shorts(queue, shape.planes))
{
    const Program program(queue.device(), "focus_volume", build_options(shape.format, low));
    if (has_byte_luma(shape.format))
        silent_ = program.kernel("focus_volume");
    prepared_ = program.kernel("focus_volume_prepared");
}

uint64_t FocusVolume::scratch_bytes(const StackShape &shape, const LowShape &low)
{
    const uint64_t rows = 2 * (low.scale <= 4 ? 8 : 16) + 4, pad = 16; /* SCRATCH_ROWS, PAD of the kernels */
    return low.strips() * shape.planes * rows * (shape.width + 2 * pad) * sizeof(cl_ushort);
}

void FocusVolume::run(const StackBuffer &stack, const NoiseEstimate &noise)
{
    const auto width = static_cast<cl_int>(shape_.width), height = static_cast<cl_int>(shape_.height);
    const cl::NDRange strips = low_.strips_of(low_.planes);
    const cl_ulong changed = stack.changed_planes();

    queue_.begin_stage("focus-volume");
    if (silent_())
        queue_.run(silent_, strips, stack.bytes(), stack.layout(), noise.noise(), changed, scratch_, volume_,
                   width, height, low_.width, low_.height, low_.stride, low_.strip);
    queue_.run(prepared_, strips, stack.bytes(), stack.layout(), colour_channels(shape_.format),
               noise.noise(), changed, scratch_, volume_, width, height, low_.width, low_.height, low_.stride,
               low_.strip);
}

} // namespace dff
