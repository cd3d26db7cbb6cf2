/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/gaussian_blur.h"

#include <cmath>
#include <numeric>

namespace dff {

std::vector<float> GaussianBlur::taps_for(unsigned sigma_xy)
{
    const double size = 1.2 * sigma_xy, sigma = 0.7 * size;
    const int radius = static_cast<int>(std::lround(size)) / 2;
    std::vector<double> weights(2 * radius + 1);
    for (int i = -radius; i <= radius; i++)
        weights[i + radius] = std::exp(-i * i / (2.0 * sigma * sigma));

    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<float> taps;
    taps.reserve(weights.size());
    for (const double weight : weights)
        taps.push_back(static_cast<float>(weight / sum));
    return taps;
}

GaussianBlur::GaussianBlur(CommandQueue &queue, uint32_t width, uint32_t height, std::span<const float> taps)
    : queue_(queue), width_(width), height_(height), radius_(static_cast<cl_int>(taps.size() / 2)),
      taps_(queue.allocate(taps.size_bytes())),
      half_blurred_(queue.allocate(size_t{width} * height * sizeof(cl_float)))
{
    const Program program(queue.device(), "gaussian_blur");
    blur_rows_ = program.kernel("blur_rows");
    blur_columns_ = program.kernel("blur_columns");
    queue.commands().enqueueWriteBuffer(taps_, CL_TRUE, 0, taps.size_bytes(), taps.data());
}

void GaussianBlur::run(const cl::Buffer &picture)
{
    const auto width = static_cast<cl_int>(width_), height = static_cast<cl_int>(height_);
    queue_.begin_stage("blur");
    queue_.run(blur_rows_, {width_, height_}, picture, half_blurred_, taps_, radius_, width);
    queue_.run(blur_columns_, {width_, height_}, half_blurred_, picture, taps_, radius_, width, height);
}

} // namespace dff
