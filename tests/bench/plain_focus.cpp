/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "plain_focus.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dff::bench {

namespace {

struct Picture {
    Picture(int width, int height) : width(width), height(height), pixels(size_t(width) * height) {}

    float *row(int y) { return pixels.data() + size_t(y) * width; }
    const float *row(int y) const { return pixels.data() + size_t(y) * width; }

    int width, height;
    std::vector<float> pixels;
};

/* Magnitude of the Sobel gradient / 8; the border stays 0. */
void gradient(const Picture &picture, Picture &result)
{
    for (int y = 1; y < picture.height - 1; y++) {
        const float *a = picture.row(y - 1), *b = picture.row(y), *c = picture.row(y + 1);
        float *out = result.row(y);
        for (int x = 1; x < picture.width - 1; x++) {
            const float dx = a[x + 1] - a[x - 1] + 2 * (b[x + 1] - b[x - 1]) + c[x + 1] - c[x - 1];
            const float dy = c[x - 1] - a[x - 1] + 2 * (c[x] - a[x]) + c[x + 1] - a[x + 1];
            out[x] = std::sqrt(dx * dx + dy * dy) * 0.125f;
        }
    }
}

void downsample(const Picture &picture, Picture &coarse, int factor)
{
    for (int y = 0; y < coarse.height; y++) {
        float *out = coarse.row(y);
        std::fill_n(out, coarse.width, 0.0f);
        for (int j = 0; j < factor; j++) {
            const float *in = picture.row(y * factor + j);
            for (int x = 0; x < coarse.width; x++)
                for (int i = 0; i < factor; i++)
                    out[x] += in[x * factor + i];
        }
        for (int x = 0; x < coarse.width; x++)
            out[x] /= static_cast<float>(factor * factor);
    }
}

/* product *= the coarse picture, bilinear. */
void multiply_upsampled(const Picture &coarse, Picture &product, int factor)
{
    std::vector<int> left(product.width);
    std::vector<float> share(product.width), blended(coarse.width + 1);
    for (int x = 0; x < product.width; x++) {
        const float p = std::clamp((x + 0.5f) / factor - 0.5f, 0.0f, coarse.width - 1.0f);
        left[x] = static_cast<int>(p);
        share[x] = p - left[x];
    }
    for (int y = 0; y < product.height; y++) {
        const float p = std::clamp((y + 0.5f) / factor - 0.5f, 0.0f, coarse.height - 1.0f);
        const int top = static_cast<int>(p);
        const float *a = coarse.row(top), *b = coarse.row(std::min(top + 1, coarse.height - 1));
        for (int x = 0; x < coarse.width; x++)
            blended[x] = a[x] + (p - top) * (b[x] - a[x]);
        blended[coarse.width] = blended[coarse.width - 1];
        float *out = product.row(y);
        for (int x = 0; x < product.width; x++)
            out[x] *= blended[left[x]] + share[x] * (blended[left[x] + 1] - blended[left[x]]);
    }
}

} // namespace

double plain_focus_measure(std::span<const uint8_t> luma, int width, int height, int planes)
{
    Picture plane(width, height), product(width, height), best(width, height), sum(width, height);
    std::vector<uint8_t> best_plane(luma.size() / planes);
    for (int z = 0; z < planes; z++) {
        std::copy_n(luma.data() + z * plane.pixels.size(), plane.pixels.size(), plane.pixels.begin());
        gradient(plane, product);
        for (const int factor : {2, 3}) {
            Picture coarse(width / factor, height / factor), coarse_gradient = coarse;
            downsample(plane, coarse, factor);
            gradient(coarse, coarse_gradient);
            multiply_upsampled(coarse_gradient, product, factor);
        }
        for (size_t i = 0; i < best_plane.size(); i++) {
            const float p = product.pixels[i];
            best_plane[i] = p > best.pixels[i] ? static_cast<uint8_t>(z) : best_plane[i];
            best.pixels[i] = std::max(best.pixels[i], p);
            sum.pixels[i] += p;
        }
    }
    double total = 0.0;
    for (size_t i = 0; i < best_plane.size(); i++)
        total += sum.pixels[i] + best_plane[i];
    return total;
}

} // namespace dff::bench
