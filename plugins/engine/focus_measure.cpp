/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/focus_measure.h"

#include <algorithm>

namespace dff {

namespace {

struct Level {
    uint32_t width, height;
};

Level level_of(const StackShape &shape, unsigned factor)
{
    return {std::max(shape.width / factor, 1u), std::max(shape.height / factor, 1u)};
}

size_t samples(const StackShape &shape, const Level &level)
{
    return size_t{level.width} * level.height * shape.planes;
}

} // namespace

FocusMeasure::FocusMeasure(CommandQueue &queue, const StackShape &shape, unsigned levels)
    : queue_(queue), shape_(shape), levels_(levels)
{
    const Program program(queue.device(), "focus_measure",
                          Luma::build_options(shape.format) + " -DLEVELS=" + std::to_string(levels));
    downsample_ = program.kernel("downsample");
    coarse_gradient_ = program.kernel("coarse_gradient");
    focus_product_ = program.kernel("focus_product");

    size_t gradients = 1;
    for (unsigned i = 2; i <= levels; i++)
        gradients += samples(shape, level_of(shape, i));
    const size_t pixels = size_t{shape.width} * shape.height;
    coarse_ = queue.allocate(samples(shape, level_of(shape, 2)) * sizeof(cl_float));
    gradient_ = queue.allocate(gradients * sizeof(cl_float));
    peak_ = queue.allocate(pixels * sizeof(cl_float));
    peak_plane_ = queue.allocate(pixels);
    mean_ = queue.allocate(pixels * sizeof(cl_float));
}

void FocusMeasure::run(const Luma &luma)
{
    const auto width = static_cast<cl_int>(shape_.width), height = static_cast<cl_int>(shape_.height);
    cl_ulong first = 0;

    queue_.begin_stage("focus-measure");
    for (unsigned i = 2; i <= levels_; i++) {
        const Level level = level_of(shape_, i);
        const cl::NDRange size(level.width, level.height, shape_.planes);
        const auto w = static_cast<cl_int>(level.width), h = static_cast<cl_int>(level.height);
        queue_.run(downsample_, size, luma.bytes(), luma.rows(), coarse_, width, height, w, h);
        queue_.run(coarse_gradient_, size, coarse_, gradient_, first, w, h);
        first += samples(shape_, level);
    }
    queue_.run(focus_product_, {shape_.width, shape_.height}, luma.bytes(), luma.rows(), gradient_, peak_,
               peak_plane_, mean_, width, height, static_cast<cl_int>(shape_.planes));
}

} // namespace dff
