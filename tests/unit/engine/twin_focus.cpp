/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "twin_focus.h"

#include "engine/luma.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dff::twin {

namespace {

int mirror(int i, int n)
{
    i = std::abs(i);
    return i < n ? i : 2 * n - 2 - i;
}

Volume gradient(const Volume &picture)
{
    Volume result(picture.width, picture.height, picture.planes);
    const auto at = [&](int x, int y, unsigned z) {
        return picture.at(mirror(x, picture.width), mirror(y, picture.height), z);
    };
    for (unsigned z = 0; z < picture.planes; z++)
        for (int y = 0; y < static_cast<int>(picture.height); y++)
            for (int x = 0; x < static_cast<int>(picture.width); x++) {
                float dx = 0.0f, dy = 0.0f;
                for (int i = -1; i <= 1; i++) {
                    const float weight = i == 0 ? 2.0f : 1.0f;
                    dx += weight * (at(x + 1, y + i, z) - at(x - 1, y + i, z));
                    dy += weight * (at(x + i, y + 1, z) - at(x + i, y - 1, z));
                }
                result.at(x, y, z) = std::hypot(dx, dy) / 8.0f;
            }
    return result;
}

/* Gradient of the picture of means over level x level pixels, one sample more on every side. */
Volume coarse_gradient(const Volume &picture, int level)
{
    const int width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
    const int columns = (width + level - 1) / level, rows = (height + level - 1) / level;
    Volume coarse(columns + 4, rows + 4, picture.planes), result(columns + 2, rows + 2, picture.planes);
    for (unsigned z = 0; z < picture.planes; z++) {
        for (int y = 0; y < rows + 4; y++)
            for (int x = 0; x < columns + 4; x++)
                for (int j = 0; j < level; j++)
                    for (int i = 0; i < level; i++)
                        coarse.at(x, y, z) += picture.at(mirror((x - 2) * level + i, width),
                                                         mirror((y - 2) * level + j, height), z) /
                                              static_cast<float>(level * level);
    }
    const Volume of_all = gradient(coarse);
    for (unsigned z = 0; z < picture.planes; z++)
        for (int y = 0; y < rows + 2; y++)
            for (int x = 0; x < columns + 2; x++)
                result.at(x, y, z) = of_all.at(x + 1, y + 1, z);
    return result;
}

float bilinear(const Volume &picture, float x, float y, unsigned z)
{
    x = std::clamp(x, 0.0f, picture.width - 1.0f);
    y = std::clamp(y, 0.0f, picture.height - 1.0f);
    const auto l = static_cast<unsigned>(x), t = static_cast<unsigned>(y);
    const unsigned r = std::min(l + 1, picture.width - 1), b = std::min(t + 1, picture.height - 1);
    return std::lerp(std::lerp(picture.at(l, t, z), picture.at(r, t, z), x - l),
                     std::lerp(picture.at(l, b, z), picture.at(r, b, z), x - l), y - t);
}

} // namespace

Volume luma(const TestStack &stack)
{
    const StackShape &shape = stack.shape;
    Volume result(shape.width, shape.height, shape.planes);
    const cl_int4 channels = colour_channels(shape.format);
    for (unsigned z = 0; z < shape.planes; z++)
        for (unsigned y = 0; y < shape.height; y++)
            for (unsigned x = 0; x < shape.width; x++) {
                const auto value = [&](int i) { return stack.value(0, i, y, z); };
                const int pixel = static_cast<int>(x) * channels.s[0];
                unsigned found = 0;
                if (is_interleaved(shape.format)) /* weights in 1/65536, so that ties round alike */
                    found = (19595 * value(pixel + channels.s[1]) + 38470 * value(pixel + channels.s[2]) +
                             7471 * value(pixel + channels.s[3]) + 32768) /
                            65536;
                else
                    found = value(x);
                result.at(x, y, z) = found * (sample_bytes(shape.format) == 2 ? 255.0f / 65535.0f : 1.0f);
            }
    return result;
}

Focus focus_product(const Volume &luma, unsigned levels)
{
    Volume product = gradient(luma);
    for (unsigned i = 2; i <= levels; i++) {
        const Volume coarse = coarse_gradient(luma, static_cast<int>(i));
        const auto position = [i](unsigned fine) { return (static_cast<float>(fine) + 0.5f) / i + 0.5f; };
        for (unsigned z = 0; z < luma.planes; z++)
            for (unsigned y = 0; y < luma.height; y++)
                for (unsigned x = 0; x < luma.width; x++)
                    product.at(x, y, z) *= bilinear(coarse, position(x), position(y), z);
    }

    Focus focus{Volume(luma.width, luma.height, 1), Volume(luma.width, luma.height, 1), {}};
    for (unsigned y = 0; y < luma.height; y++)
        for (unsigned x = 0; x < luma.width; x++) {
            unsigned best = 0, place = 0;
            for (unsigned z = 0; z < luma.planes; z++) {
                if (product.at(x, y, z) > product.at(x, y, best)) {
                    best = z;
                    place = 2 * z;
                } else if (z > best && product.at(x, y, z) == product.at(x, y, best)) {
                    place++;
                }
                focus.mean.at(x, y) += product.at(x, y, z) / luma.planes;
            }
            focus.peak.at(x, y) = product.at(x, y, best);
            focus.place.push_back(static_cast<uint8_t>(place));
        }
    return focus;
}

std::vector<uint8_t> z_entropy(const Volume &luma, float threshold_bits)
{
    std::vector<uint8_t> moved;
    for (unsigned y = 0; y < luma.height; y++)
        for (unsigned x = 0; x < luma.width; x++) {
            std::array<double, 16> histogram{};
            for (unsigned z = 0; z < luma.planes; z++)
                histogram[static_cast<unsigned>(luma.at(x, y, z)) / 16] += 1.0 / luma.planes;
            double entropy = 0.0;
            for (const double p : histogram)
                entropy -= p > 0.0 ? p * std::log2(p) : 0.0;
            moved.push_back(entropy > threshold_bits ? 255 : 0);
        }
    return moved;
}

std::vector<uint8_t> sparse_depth(const Focus &focus, const std::vector<uint8_t> *moved, float tolerance)
{
    const int width = focus.peak.width, height = focus.peak.height;
    double total_mean = 0.0;
    for (const float mean : focus.mean.values)
        total_mean += mean / focus.mean.values.size();

    std::vector<uint8_t> sparse;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            float highest = 0.0f;
            for (int j = std::max(y - 3, 0); j <= std::min(y + 3, height - 1); j++)
                for (int i = std::max(x - 3, 0); i <= std::min(x + 3, width - 1); i++)
                    highest = std::max(highest, focus.peak.at(i, j));
            const float p = focus.peak.at(x, y);
            const bool sharp =
                p > 0.0f && p >= tolerance * focus.mean.at(x, y) && p >= total_mean && p >= 0.5f * highest;
            const size_t pixel = static_cast<size_t>(y) * width + x;
            sparse.push_back(sharp && !(moved && (*moved)[pixel]) ? focus.place[pixel] : 255);
        }
    return sparse;
}

std::vector<uint8_t> mean_luma(const Volume &luma)
{
    std::vector<uint8_t> mean;
    for (unsigned y = 0; y < luma.height; y++)
        for (unsigned x = 0; x < luma.width; x++) {
            float sum = 0.0f;
            for (unsigned z = 0; z < luma.planes; z++)
                sum += luma.at(x, y, z);
            mean.push_back(static_cast<uint8_t>(sum / luma.planes));
        }
    return mean;
}

Volume gaussian_blur(const Volume &picture, const std::vector<float> &taps)
{
    const int radius = static_cast<int>(taps.size() / 2);
    Volume rows(picture.width, picture.height, 1), result(picture.width, picture.height, 1);
    for (unsigned y = 0; y < picture.height; y++)
        for (unsigned x = 0; x < picture.width; x++)
            for (int i = -radius; i <= radius; i++)
                rows.at(x, y) +=
                    taps[i + radius] * picture.at(mirror(static_cast<int>(x) + i, picture.width), y);
    for (unsigned y = 0; y < picture.height; y++)
        for (unsigned x = 0; x < picture.width; x++)
            for (int i = -radius; i <= radius; i++)
                result.at(x, y) +=
                    taps[i + radius] * rows.at(x, mirror(static_cast<int>(y) + i, picture.height));
    return result;
}

} // namespace dff::twin
