/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/light_field_layers.h"

#include <memory>
#include <optional>
#include <span>

namespace dff {

/* A colour picture of four interleaved bytes or three, and what is made of it, in the same format. */
struct LightFieldShape {
    PixelFormat format; /* Rgb, Bgr, Rgbx or Bgrx */
    PictureSize picture;
    PictureSize output;

    bool operator==(const LightFieldShape &) const = default;
};

/* Colour and depth to what a light-field display shows. Not to be used from two threads at once.
 *
 * A view that looks from the slope t sees a point of the height h (in pixels before the plane of zero
 * parallax, linear in dioptres) shifted by -t h: exactly what off-axis cameras side by side see. Rays are
 * traced back to the picture, so that every pixel of every view is found at its sub-pixel position;
 * kernels/light_field_trace.cl says how. */
class LightFieldRenderer {
public:
    /* Throws EngineError. */
    LightFieldRenderer(std::shared_ptr<Device> device, const LightFieldShape &shape,
                       const LightFieldParameters &parameters);

    /* From the next picture on. Throws EngineError. */
    void set_parameters(const LightFieldParameters &parameters);

    /* Where in the sweep each of the 65536 values of a depth pixel lies, linear in dioptres: 0 is the near
     * end, 1 the far one, NAN no value. As of unit=index until then. */
    void set_positions(std::span<const float> positions);

    /* Rows of pixels in host memory; the stride is in bytes. */
    struct Rows {
        std::span<const std::byte> memory;
        size_t stride;
    };

    /* Writes the output's rows. The depth map has 16 bits a pixel and the picture's size. Throws EngineError.
     */
    void render(const Rows &color, const Rows &depth, std::span<std::byte> output, size_t output_stride);

    /* Of the last picture. */
    const StageTimes &times() const { return times_; }

private:
    struct Output {
        cl::Buffer rows;
        cl_ulong stride;
    };

    cl::Buffer wrap(std::span<const std::byte> memory, cl_mem_flags access) const;
    cl::Buffer upload(const std::vector<cl_float> &values);
    void prepare_rows();
    void trace(const Output &output);
    void trace_views(cl_uint index, const Output &output);
    void trace_lenticular(cl_uint index, const Output &output);
    void trace_elemental(cl_uint index, const Output &output);
    void copy_rgbd(const ColorAndDepth &pictures, const Output &output);
    template <typename... Arguments>
    void set_trace_arguments(cl_uint index, const Output &output, const Arguments &...arguments);

    std::shared_ptr<Device> device_;
    LightFieldShape shape_;
    LightFieldParameters parameters_;
    LightFieldGeometry geometry_;
    CommandQueue queue_;
    std::optional<LightFieldLayers> layers_;
    std::optional<LightFieldLayout> built_; /* what kernel_ is for */
    cl::Kernel kernel_, place_color_;       /* the latter is of Rgbd */
    cl::Buffer positions_, slopes_, shifts_;

    /* Of kernels in rows: the columns of the layers they work on, and their memory. */
    LightFieldGeometry::Columns columns_{};
    cl_int scratch_size_ = 0;
    cl::Buffer scratch_;
    StageTimes times_;
};

} // namespace dff
