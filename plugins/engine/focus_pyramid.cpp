/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/focus_pyramid.h"

#include <algorithm>

namespace dff {

namespace {

constexpr cl_int coarsest = 16;     /* pixels a cell */
constexpr cl_int least_cells = 16;  /* of a coarser level, in both directions */
constexpr size_t scratch_rows = 10; /* SCRATCH_ROWS of the kernels */

std::vector<LowShape> shapes_of(const LowShape &low)
{
    std::vector<LowShape> shapes{low};
    while (shapes.back().scale < coarsest &&
           std::min(shapes.back().width, shapes.back().height) >= 2 * least_cells)
        shapes.push_back(shapes.back().halved());
    return shapes;
}

size_t scratch_of(const LowShape &low)
{
    return low.strips() * static_cast<size_t>(low.planes) * scratch_rows;
}

} // namespace

FocusPyramid::FocusPyramid(CommandQueue &queue, const LowShape &low)
    : queue_(queue), scratch_(low.allocate_rows(queue, scratch_of(low), sizeof(cl_short)))
{
    const Program program(queue.device(), "focus_pyramid");
    mean_colours_ = program.kernel("mean_colours");
    halve_luma_ = program.kernel("halve_luma");
    measure_focus_ = program.kernel("measure_focus");
    for (const LowShape &shape : shapes_of(low))
        levels_.push_back(
            {shape, shape.allocate_shorts(queue, shape.planes), shape.allocate_shorts(queue, shape.planes)});
}

uint64_t FocusPyramid::memory(const LowShape &low)
{
    const uint64_t row = sizeof(cl_short) * static_cast<uint64_t>(low.stride);
    uint64_t bytes = scratch_of(low) * row;
    for (const LowShape &shape : shapes_of(low))
        bytes += uint64_t{2} * shape.planes * shape.height * shape.stride * sizeof(cl_short);
    return bytes;
}

void FocusPyramid::run(const SmallPlanes &small, const NoiseEstimate &noise, const StackBuffer &stack)
{
    queue_.begin_stage("focus-pyramid");
    const cl_ulong changed = stack.changed_planes();
    const LowShape &finest = levels_.front().shape;
    queue_.run(mean_colours_, finest.rows_of_planes(), small.colours(), changed, noise.noise(),
               levels_.front().luma, finest.width, finest.stride);
    for (size_t i = 1; i < levels_.size(); i++) {
        const Level &finer = levels_[i - 1];
        const LowShape &shape = levels_[i].shape;
        queue_.run(halve_luma_, shape.rows_of_planes(), finer.luma, finer.shape.height, finer.shape.stride,
                   changed, noise.noise(), levels_[i].luma, shape.width, shape.stride);
    }
    for (const Level &level : levels_) {
        const LowShape &shape = level.shape;
        queue_.run(measure_focus_, shape.strips_of(shape.planes), level.luma, changed, noise.noise(),
                   level.focus, scratch_, shape.width, shape.height, shape.stride, shape.strip);
    }
}

} // namespace dff
