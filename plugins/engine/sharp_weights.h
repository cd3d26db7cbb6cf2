/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/luma.h"
#include "optics/depth_scale.h"

#include <array>

namespace dff {

/* The levels of kernels/pyramid_rows.cl over pictures of one size; level 0 is the picture itself. */
struct PyramidShape {
    /* Level of pyramid_rows.cl. */
    struct Level {
        cl_int width, height, stride; /* cells */

        /* Work-items: 16 cells of a row each, of one picture or of several. */
        cl::NDRange blocks(size_t pictures = 1) const
        {
            return {(static_cast<size_t>(width) + 15) / 16, static_cast<size_t>(height), pictures};
        }
        size_t cells() const { return static_cast<size_t>(height) * static_cast<size_t>(stride); }
    };

    PyramidShape(uint32_t width, uint32_t height);

    static constexpr size_t top = 5; /* a cell of 32 pixels: the smallest picture has two of them in a row */
    std::array<Level, top + 1> levels;
};

/* How much of each plane a picture takes in each band of detail: the sharpest edge around, among the planes
 * near the depth, decides. Formula in kernels/sharp_weights.cl. */
class SharpWeights {
public:
    SharpWeights(CommandQueue &queue, const StackShape &shape, const PyramidShape &pyramid,
                 const DepthEncoder &encoder);

    void set_encoder(const DepthEncoder &encoder);

    /* `depth_stride` is in pixels. */
    void run(const StackBuffer &stack, const cl::Buffer &depth, size_t depth_stride);

    /* A volume of bytes: of the band of level 1 and more; at 0, in cells of level 1, of the finest band. */
    const cl::Buffer &of_level(size_t level) const { return weights_[level]; }

private:
    /* One buffer a level; of level 0 there are weights alone. */
    using Buffers = std::array<cl::Buffer, PyramidShape::top + 1>;

    void weigh_finest();
    void weigh_band(size_t level);
    const cl::Buffer &dilate(size_t level, cl::Kernel &greatest);
    void weigh(size_t band, size_t level, const cl::Buffer &around, cl_int squarings);

    CommandQueue &queue_;
    StackShape shape_;
    PyramidShape pyramid_;
    Luma luma_;
    cl::Kernel measure_, greatest_of_four_, least_of_four_, greatest_of_three_, greatest_of_five_, soften_,
        soften_upon_, nearest_of_pixels_, weigh_;
    Buffers sharpness_; /* F, and when the level's weights are made D */
    Buffers nearest_, weights_;
    std::array<cl::Buffer, 2> spread_; /* of the level at work */
    cl::Buffer positions_;
};

} // namespace dff
