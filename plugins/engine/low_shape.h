/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/command_queue.h"
#include "engine/stack_shape.h"

namespace dff {

/* Pictures at 1/scale of a stack's resolution, as kernels/low_picture.cl lays them out. Pixels at the right
 * and the bottom that do not fill a cell have none. */
struct LowShape {
    /* `scale` as of DepthParameters. Throws EngineError (Failed) if it is none of 0, 2, 4, 8. */
    LowShape(const StackShape &shape, unsigned scale);

    /* The scale by size and blur, where it is `now`. */
    static unsigned scale_for(const StackShape &shape, float blur_step, cl_int now);

    /* Of pictures at half this resolution. */
    LowShape halved() const;

    static constexpr cl_int side = 16; /* SIDE of low_picture.cl */

    cl_int scale;
    cl_int width, height; /* cells */
    cl_int stride;        /* cells */
    cl_int planes;
    cl_int strip; /* rows a work-item takes, where it takes more than one */

    /* Room for `pictures` low pictures, all 0. */
    cl::Buffer allocate(CommandQueue &queue, size_t pictures) const;
    cl::Buffer allocate_shorts(CommandQueue &queue, size_t pictures) const;

    /* Room for `rows` rows of low pictures whose cells have `cell_bytes`, all 0. */
    cl::Buffer allocate_rows(CommandQueue &queue, size_t rows, size_t cell_bytes) const;

    /* Work-items: a row each, of one picture or of several. */
    cl::NDRange rows() const { return {1, static_cast<size_t>(height)}; }
    cl::NDRange rows_of(size_t pictures) const { return {1, static_cast<size_t>(height), pictures}; }
    cl::NDRange rows_of_planes() const { return rows_of(planes); }

    /* Work-items: a strip each. */
    size_t strips() const { return static_cast<size_t>((height + strip - 1) / strip); }
    cl::NDRange strips_of(size_t pictures) const { return {1, strips(), pictures}; }
};

} // namespace dff
