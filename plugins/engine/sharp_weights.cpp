/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/sharp_weights.h"

namespace dff {

namespace {

/* sharp_weights.cl */
constexpr cl_int squarings_of_bands = 5, squarings_of_finest = 6;
constexpr cl_int2 along_row{{1, 0}}, along_column{{0, 1}};

} // namespace

PyramidShape::PyramidShape(uint32_t width, uint32_t height)
{
    constexpr cl_int side = 16; /* SIDE */
    auto w = static_cast<cl_int>(width), h = static_cast<cl_int>(height);
    for (Level &level : levels) {
        /* Room for the 32 cells under the last 16 of the next level. */
        level = {w, h, (w + 31) / 32 * 32 + 2 * side};
        w = (w + 1) / 2;
        h = (h + 1) / 2;
    }
}

SharpWeights::SharpWeights(CommandQueue &queue, const StackShape &shape, const PyramidShape &pyramid,
                           const DepthEncoder &encoder)
    : queue_(queue), shape_(shape), pyramid_(pyramid), luma_(queue, shape),
      positions_(queue.allocate((DepthScale::max_pixel + 1) * sizeof(cl_float)))
{
    const Program program(queue.device(), "sharp_weights", Luma::build_options(shape.format));
    measure_ = program.kernel("sharpness");
    greatest_of_four_ = program.kernel("greatest_of_four");
    least_of_four_ = program.kernel("least_of_four");
    greatest_of_three_ = program.kernel("greatest_of_three");
    greatest_of_five_ = program.kernel("greatest_of_five");
    soften_ = program.kernel("soften");
    soften_upon_ = program.kernel("soften_upon");
    nearest_of_pixels_ = program.kernel("nearest_of_pixels");
    weigh_ = program.kernel("weigh");
    for (size_t l = 1; l < weights_.size(); l++) {
        const size_t cells = pyramid_.levels[l].cells();
        sharpness_[l] = queue.allocate(cells * shape.planes * sizeof(cl_ushort));
        nearest_[l] = queue.allocate(cells * sizeof(cl_ushort));
        weights_[l] = queue.allocate(cells * shape.planes);
    }
    weights_[0] = queue.allocate(pyramid_.levels[1].cells() * shape.planes);
    for (cl::Buffer &volume : spread_)
        volume = queue.allocate(pyramid_.levels[1].cells() * shape.planes * sizeof(cl_ushort));
    set_encoder(encoder);
}

void SharpWeights::set_encoder(const DepthEncoder &encoder)
{
    std::vector<cl_float> positions(DepthScale::max_pixel + 1);
    for (unsigned pixel = 0; pixel < positions.size(); pixel++)
        positions[pixel] = static_cast<cl_float>(encoder.decode(static_cast<uint16_t>(pixel)).value_or(-1.0));
    queue_.commands().enqueueWriteBuffer(positions_, CL_TRUE, 0, positions.size() * sizeof(cl_float),
                                         positions.data());
}

void SharpWeights::run(const StackBuffer &stack, const cl::Buffer &depth, size_t depth_stride)
{
    const auto &levels = pyramid_.levels;
    const cl_int2 size{{levels[0].width, levels[0].height}};
    const size_t planes = shape_.planes;

    luma_.run(stack);
    queue_.begin_stage("sharpness");
    queue_.run(measure_, levels[1].blocks(planes), luma_.bytes(), luma_.rows(), size, sharpness_[1],
               levels[1]);
    queue_.run(nearest_of_pixels_, levels[1].blocks(), depth, static_cast<cl_int>(depth_stride), size,
               nearest_[1], levels[1]);
    for (size_t l = 2; l < weights_.size(); l++) {
        queue_.run(greatest_of_four_, levels[l].blocks(planes), sharpness_[l - 1], levels[l - 1],
                   sharpness_[l], levels[l]);
        queue_.run(least_of_four_, levels[l].blocks(), nearest_[l - 1], levels[l - 1], nearest_[l],
                   levels[l]);
    }

    queue_.begin_stage("weights");
    weigh_finest();
    for (size_t l = PyramidShape::top; l > 0; l--)
        weigh_band(l);
}

void SharpWeights::weigh_finest()
{
    const PyramidShape::Level &level = pyramid_.levels[1];
    const cl::Buffer &rows = dilate(1, greatest_of_three_), &around = spread_[1];
    queue_.run(soften_, level.blocks(shape_.planes), rows, around, level, along_column);
    weigh(0, 1, around, squarings_of_finest);
}

void SharpWeights::weigh_band(size_t l)
{
    const PyramidShape::Level &level = pyramid_.levels[l];
    const cl::NDRange blocks = level.blocks(shape_.planes);
    const cl::Buffer &rows = dilate(l, greatest_of_five_), &around = sharpness_[l];
    if (l == PyramidShape::top)
        queue_.run(soften_, blocks, rows, around, level, along_column);
    else
        queue_.run(soften_upon_, blocks, rows, around, level, along_column, sharpness_[l + 1],
                   pyramid_.levels[l + 1]);
    weigh(l, l, around, squarings_of_bands);
}

/* Softened along rows alone. */
const cl::Buffer &SharpWeights::dilate(size_t l, cl::Kernel &greatest)
{
    const PyramidShape::Level &level = pyramid_.levels[l];
    const cl::NDRange blocks = level.blocks(shape_.planes);
    queue_.run(greatest, blocks, sharpness_[l], spread_[0], level, along_row);
    queue_.run(greatest, blocks, spread_[0], spread_[1], level, along_column);
    queue_.run(soften_, blocks, spread_[1], spread_[0], level, along_row);
    return spread_[0];
}

void SharpWeights::weigh(size_t band, size_t l, const cl::Buffer &around, cl_int squarings)
{
    const PyramidShape::Level &level = pyramid_.levels[l];
    queue_.run(weigh_, level.blocks(), around, nearest_[l], positions_, weights_[band], level,
               static_cast<cl_int>(shape_.planes), squarings);
}

} // namespace dff
