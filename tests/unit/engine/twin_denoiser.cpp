/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "twin_denoiser.h"

#include "noisy_stack.h"

#include <algorithm>
#include <cmath>

namespace dff::twin {

Denoiser::Denoiser(const StackShape &shape)
    : shape_(shape), component_(shape.components().front()),
      width_(8 / component_.subsampling * component_.channels), rows_(8 / component_.subsampling),
      across_((shape.width + 7) / 8), down_((shape.height + 7) / 8),
      means_(size_t{shape.planes} * component_.width * component_.height),
      sweeps_(shape.planes, std::vector<uint8_t>(tiles(), 0))
{
}

size_t Denoiser::mean_at(unsigned x, unsigned y, unsigned z) const
{
    return (size_t{z} * component_.height + y) * component_.width + x;
}

/* A tile that is cut off reaches back over the one before. */
TileDifference Denoiser::difference(const TestStack &stack, unsigned z, unsigned tile) const
{
    const unsigned x0 = std::min(tile % across_ * width_, component_.width - width_);
    const unsigned y0 = std::min(tile / across_ * rows_, component_.height - rows_);
    double sum = 0.0, squares = 0.0, brightness = 0.0;
    for (unsigned y = y0; y < y0 + rows_; y++)
        for (unsigned x = x0; x < x0 + width_; x++) {
            const double m = means_[mean_at(x, y, z)];
            const double d = sample_of(stack, component_, stack.layout[z], x, y) - m;
            sum += d;
            squares += d * d;
            brightness += m;
        }
    const double n = width_ * rows_;
    return {static_cast<float>(sum / n), static_cast<float>(squares / n), static_cast<float>(brightness / n),
            0};
}

bool Denoiser::is_moved(const TileDifference &tile, const NoiseCurve &curve, unsigned sweeps,
                        float spread) const
{
    const float white = component_.sample_bytes == 2 ? 65536.0F : 256.0F;
    const float least = 0.3F * white / 256.0F;
    const float place = std::clamp(tile.brightness * 16.0F / white - 0.5F, 0.0F, 15.0F);
    const auto i = std::min(static_cast<size_t>(place), size_t{14});
    const float variance = std::lerp(curve[i], curve[i + 1], place - static_cast<float>(i)) *
                           (1.0F + 1.0F / static_cast<float>(std::max(sweeps, 1U)));
    const float part = 2 * spread / (9 * samples()), root = 1 - part + 5 * std::sqrt(part);
    return std::fabs(tile.mean) > 6 * std::sqrt(variance * spread / samples()) + least ||
           tile.square > variance * root * root * root + least;
}

void Denoiser::count(std::vector<uint8_t> &sweeps, const std::vector<bool> &moved, unsigned frames) const
{
    const int across = static_cast<int>(across_), down = static_cast<int>(down_);
    for (int i = 0; i < across * down; i++) {
        bool near = false;
        for (int y = std::max(i / across - 1, 0); y <= std::min(i / across + 1, down - 1); y++)
            for (int x = std::max(i % across - 1, 0); x <= std::min(i % across + 1, across - 1); x++)
                near = near || moved[static_cast<size_t>(y) * across_ + static_cast<size_t>(x)];
        auto &k = sweeps[static_cast<size_t>(i)];
        k = near ? 1 : static_cast<uint8_t>(std::min<unsigned>(k + 1U, frames));
    }
}

void Denoiser::average(TestStack &stack, unsigned z)
{
    const RowLayout &rows = stack.layout[z];
    for (unsigned y = 0; y < component_.height; y++)
        for (unsigned x = 0; x < component_.width; x++) {
            double &mean = means_[mean_at(x, y, z)];
            mean += (sample_of(stack, component_, rows, x, y) - mean) /
                    sweeps_[z][(y / rows_) * across_ + x / width_];
            set_sample(stack, component_, rows, x, y, mean);
        }
}

void Denoiser::denoise(TestStack &stack, const NoiseCurve &curve, float spread, unsigned frames)
{
    std::vector<bool> moved(tiles());
    for (unsigned z = 0; z < shape_.planes; z++)
        for (unsigned tile = 0; tile < tiles(); tile++)
            moved[tile] =
                moved[tile] || is_moved(difference(stack, z, tile), curve, sweeps_[z][tile], spread);
    for (unsigned z = 0; z < shape_.planes; z++) {
        count(sweeps_[z], moved, frames);
        average(stack, z);
    }
}

} // namespace dff::twin
