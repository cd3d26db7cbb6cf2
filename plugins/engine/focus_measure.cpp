/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/focus_measure.h"

namespace dff {

namespace {

/* Samples of a level with `margin` more on every side. */
struct Level {
    Level(const StackShape &shape, unsigned factor, unsigned margin)
        : width((shape.width + factor - 1) / factor + 2 * margin),
          height((shape.height + factor - 1) / factor + 2 * margin), planes(shape.planes)
    {
    }

    size_t samples() const { return size_t{width} * height * planes; }
    cl::NDRange range() const { return {width, height, planes}; }

    uint32_t width, height, planes;
};

constexpr unsigned coarse_margin = 2, gradient_margin = 1;

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
        gradients += Level(shape, i, gradient_margin).samples();
    const size_t pixels = size_t{shape.width} * shape.height;
    coarse_ = queue.allocate(Level(shape, 2, coarse_margin).samples() * sizeof(cl_float));
    gradient_ = queue.allocate(gradients * sizeof(cl_float));
    peak_ = queue.allocate(pixels * sizeof(cl_float));
    place_ = queue.allocate(pixels);
    mean_ = queue.allocate(pixels * sizeof(cl_float));
}

void FocusMeasure::run(const Luma &luma)
{
    const auto width = static_cast<cl_int>(shape_.width), height = static_cast<cl_int>(shape_.height);
    cl_ulong first = 0;

    queue_.begin_stage("focus-measure");
    for (unsigned i = 2; i <= levels_; i++) {
        const Level coarse(shape_, i, coarse_margin), gradient(shape_, i, gradient_margin);
        queue_.run(downsample_, coarse.range(), luma.bytes(), luma.rows(), coarse_, width, height,
                   static_cast<cl_int>(coarse.width), static_cast<cl_int>(coarse.height),
                   static_cast<cl_int>(i));
        queue_.run(coarse_gradient_, gradient.range(), coarse_, gradient_, first,
                   static_cast<cl_int>(gradient.width), static_cast<cl_int>(gradient.height));
        first += gradient.samples();
    }
    queue_.run(focus_product_, {shape_.width, shape_.height}, luma.bytes(), luma.rows(), gradient_, peak_,
               place_, mean_, width, height, static_cast<cl_int>(shape_.planes));
}

} // namespace dff
