/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/light_field_geometry.h"
#include "engine/opencl/command_queue.h"

namespace dff {

/* A colour picture and its depth map as the kernels read them. */
struct ColorAndDepth {
    cl::Buffer color, depth;
    cl_ulong color_stride, depth_stride; /* bytes */
    cl_int channels;                     /* bytes a pixel of the colour picture, 3 or 4 */
    PictureSize size;
};

/* The relief that views look at: the layer that is seen and the one it hides. */
class LightFieldLayers {
public:
    /* Steps of more than this share of the sweep are edges of things, which hide what is behind them. */
    static constexpr double edge_step = 0.02;

    LightFieldLayers(CommandQueue &queue, glm::ivec2 size, PictureSize source);

    glm::ivec2 size() const { return size_; }

    /* positions: float[65536], the place in the sweep of each depth pixel, 0 near to 1 far, NAN unknown. */
    void run(const ColorAndDepth &pictures, const cl::Buffer &positions, const LightFieldGeometry &geometry);

    /* For kernels that trace rays one by one. */
    void raise_roof(const LightFieldGeometry &geometry);

    /* Sets the arguments that each tracing kernel begins with and returns how many these are. */
    cl_uint set_arguments(cl::Kernel &kernel, const LightFieldGeometry &geometry, bool fill) const;

private:
    void shrink_color(const ColorAndDepth &pictures, cl_int2 columns);

    CommandQueue &queue_;
    glm::ivec2 size_;
    bool in_rows_;
    cl_int sums_size_;
    cl::Buffer sums_; /* of shrinking in rows */
    cl::Kernel shrink_color_, height_of_depth_, fill_unknown_, hide_, raise_roof_, join_roof_;
    cl::Buffer color_, height_, hidden_color_, hidden_height_, grounds_, roof_;
};

cl_float2 to_float2(glm::dvec2 vector);
cl_int2 to_int2(glm::ivec2 vector);

} // namespace dff
