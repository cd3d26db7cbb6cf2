/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/low_filter.h"

#include "engine/opencl/program.h"

#include <cmath>

namespace dff {

LowFilter::LowFilter(CommandQueue &queue, const LowShape &low, std::span<const float> taps,
                     const cl::Buffer &noise)
    : queue_(queue), low_(low), taps_(queue.allocate(taps.size_bytes())), noise_(noise),
      radius_(static_cast<cl_int>(taps.size()) - 1)
{
    const Program program(queue.device(), "low_filter");
    mirror_sides_ = program.kernel("mirror_sides");
    filter_columns_ = program.kernel("filter_columns");
    filter_rows_ = program.kernel("filter_rows");
    queue.commands().enqueueWriteBuffer(taps_, CL_TRUE, 0, taps.size_bytes(), taps.data());
}

std::vector<float> LowFilter::box(unsigned radius)
{
    return std::vector<float>(radius + 1, 1.0f / static_cast<float>(2 * radius + 1));
}

std::vector<float> LowFilter::gaussian(unsigned radius, float sigma)
{
    std::vector<float> taps;
    float sum = 0.0f;
    for (unsigned i = 0; i <= radius; i++) {
        taps.push_back(std::exp(-static_cast<float>(i * i) / (2.0f * sigma * sigma)));
        sum += i == 0 ? taps[i] : 2.0f * taps[i];
    }
    for (float &tap : taps)
        tap /= sum;
    return taps;
}

void LowFilter::run(const cl::Buffer &source, const cl::Buffer &between, const cl::Buffer &filtered,
                    size_t pictures)
{
    queue_.run(filter_columns_, low_.rows_of(pictures), source, between, taps_, radius_, noise_, low_.width,
               low_.stride);
    mirror_sides(between, pictures);
    queue_.run(filter_rows_, low_.rows_of(pictures), between, filtered, taps_, radius_, noise_, low_.width,
               low_.stride);
}

void LowFilter::mirror_sides(const cl::Buffer &volume, size_t pictures)
{
    queue_.run(mirror_sides_, low_.rows_of(pictures), volume, noise_, low_.width, low_.stride);
}

} // namespace dff
