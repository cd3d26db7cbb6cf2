/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "twin_volume.h"

#include "engine/luma.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace dff::twin {

namespace {

/* Ends repeated: -1 is 0. */
int reflect(int i, unsigned n)
{
    const int size = static_cast<int>(n);
    i = i < 0 ? -1 - i : i;
    i = i < size ? i : 2 * size - 1 - i;
    return std::clamp(i, 0, size - 1);
}

/* Ends not repeated: -1 is 1. */
int mirror(int i, unsigned n)
{
    const int size = static_cast<int>(n);
    i = std::abs(i);
    return std::clamp(i < size ? i : 2 * size - 2 - i, 0, size - 1);
}

float at(const Volume &v, int x, int y, unsigned z = 0)
{
    return v.at(reflect(x, v.width), reflect(y, v.height), z);
}

using Value = std::function<float(int x, int y, unsigned z)>;

Volume make(unsigned width, unsigned height, unsigned planes, const Value &value)
{
    Volume result(width, height, planes);
    for (unsigned z = 0; z < planes; z++)
        for (unsigned y = 0; y < height; y++)
            for (unsigned x = 0; x < width; x++)
                result.at(x, y, z) = value(static_cast<int>(x), static_cast<int>(y), z);
    return result;
}

Volume like(const Volume &v, const Value &value)
{
    return make(v.width, v.height, v.planes, value);
}

/* taps from the centre outward, their sum over both sides 1. */
Volume filter(const Volume &v, const std::vector<float> &taps, int (*border)(int, unsigned))
{
    const int radius = static_cast<int>(taps.size()) - 1;
    return like(v, [&](int x, int y, unsigned z) {
        float sum = 0.0f;
        for (int j = -radius; j <= radius; j++)
            for (int i = -radius; i <= radius; i++)
                sum += taps[std::abs(i)] * taps[std::abs(j)] *
                       v.at(border(x + i, v.width), border(y + j, v.height), z);
        return sum;
    });
}

Volume box(const Volume &v, int radius)
{
    return filter(v, std::vector<float>(radius + 1, 1.0f / static_cast<float>(2 * radius + 1)), reflect);
}

Volume sml(const Volume &v, int step, int (*border_x)(int, unsigned), int (*border_y)(int, unsigned))
{
    return like(v, [&](int x, int y, unsigned z) {
        const auto sample = [&](int i, int j) {
            return v.at(border_x(i, v.width), border_y(j, v.height), z);
        };
        return std::abs(2 * sample(x, y) - sample(x - step, y) - sample(x + step, y)) +
               std::abs(2 * sample(x, y) - sample(x, y - step) - sample(x, y + step));
    });
}

float distance(const Colours &a, int ax, int ay, const Colours &b, int bx, int by)
{
    float sum = 0.0f;
    for (size_t c = 0; c < a.size(); c++)
        sum += std::abs(at(a[c], ax, ay) - at(b[c], bx, by));
    return sum;
}

/* What a cell's own band says of plane z: C1 or C2. */
float coarse_cost(const Volume &coarse, const Volume &top, const Volume &range, float median_range, int x,
                  int y, unsigned z)
{
    return (top.at(x, y) - coarse.at(x, y, z)) / (range.at(x, y) + 4.0f * (median_range + 0.5f));
}

/* (1 - k0)^2 */
float silence(float fine_range, float median_fine_range)
{
    const float silent = 1.0f - fine_range / (fine_range + 0.5f * (median_fine_range + 2.0f));
    return silent * silent;
}

} // namespace

Volume mean_of_colours(const TestStack &stack)
{
    const StackShape &s = stack.shape;
    return make(s.width, s.height, s.planes, [&](int x, int y, unsigned z) -> float {
        if (!is_interleaved(s.format))
            return stack.dn(0, x, y, z);
        const int first = x * colour_channels(s.format).s[0];
        return (stack.dn(0, first, y, z) + stack.dn(0, first + 1, y, z) + stack.dn(0, first + 2, y, z)) /
               3.0f;
    });
}

Volume average_squares(const Volume &planes, unsigned scale)
{
    const int size = static_cast<int>(scale);
    return make(planes.width / scale, planes.height / scale, planes.planes, [&](int x, int y, unsigned z) {
        float sum = 0.0f;
        for (int j = 0; j < size; j++)
            for (int i = 0; i < size; i++)
                sum += planes.at(x * size + i, y * size + j, z);
        return sum / static_cast<float>(size * size);
    });
}

Volume fine_focus(const Volume &luma, const Noise &noise, unsigned scale)
{
    std::vector<float> taps;
    for (const cl_int tap : noise.taps)
        taps.push_back(static_cast<float>(tap) / 64.0f);
    const Volume blurred = filter(luma, taps, mirror);
    const Volume response = sml(blurred, 1, mirror, mirror);
    return average_squares(
        filter(response, std::vector<float>(scale / 2 + 1, 1.0f / static_cast<float>(scale + 1)), mirror),
        scale);
}

Volume smooth_along_z(const Volume &focus, float t)
{
    const int last = static_cast<int>(focus.planes) - 1;
    return like(focus, [&](int x, int y, unsigned z) {
        const int plane = static_cast<int>(z);
        return (0.7f * t *
                    (focus.at(x, y, std::max(plane - 1, 0)) + focus.at(x, y, std::min(plane + 1, last))) +
                2.0f * focus.at(x, y, z)) /
               (2.0f + 1.4f * t);
    });
}

Volume top_of(const Volume &focus)
{
    return make(focus.width, focus.height, 1, [&](int x, int y, unsigned) {
        float top = 0.0f;
        for (unsigned z = 0; z < focus.planes; z++)
            top = std::max(top, focus.at(x, y, z));
        return top;
    });
}

Volume range_of(const Volume &focus)
{
    const Volume top = top_of(focus);
    return make(focus.width, focus.height, 1, [&](int x, int y, unsigned) {
        float least = focus.at(x, y, 0);
        for (unsigned z = 1; z < focus.planes; z++)
            least = std::min(least, focus.at(x, y, z));
        return top.at(x, y) - least;
    });
}

float median(std::vector<float> values)
{
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

Volume fine_cost(const Volume &focus, float median_top, float t)
{
    const Volume top = top_of(focus);
    const float floor = (0.4f + 0.35f * t) * median_top + 1.5f + (8.5f - 6.0f * t) * t;
    return like(focus, [&](int x, int y, unsigned z) {
        return (top.at(x, y) - focus.at(x, y, z)) / (top.at(x, y) + floor);
    });
}

Volume coarse_focus(const Colours &small)
{
    const std::vector<float> taps{6.0f / 16.0f, 4.0f / 16.0f, 1.0f / 16.0f};
    Volume result(small[0].width, small[0].height, small[0].planes);
    for (const Volume &colour : small) {
        const Volume response = sml(filter(colour, taps, reflect), 2, reflect, mirror);
        for (size_t i = 0; i < result.values.size(); i++)
            result.values[i] += response.values[i] / 3.0f;
    }
    return box(result, 3);
}

Volume cost(const Volume &fine_cost, const Volume &fine, const Volume &coarse, float median_fine_range,
            float median_range, float t)
{
    const Volume fine_range = range_of(fine), range = range_of(coarse), top = top_of(coarse);
    return like(fine, [&](int x, int y, unsigned z) {
        return fine_cost.at(x, y, z) + (1.4f - 0.4f * t) * silence(fine_range.at(x, y), median_fine_range) *
                                           coarse_cost(coarse, top, range, median_range, x, y, z);
    });
}

Volume widen(const Volume &coarse, int spacing)
{
    return like(coarse, [&](int x, int y, unsigned z) {
        float sum = 0.0f;
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++)
                sum += at(coarse, x + i * spacing, y + j * spacing, z);
        return sum / 9.0f;
    });
}

Volume first_guess(const Volume &cost, const Volume &fine, const Volume &wide, float median_fine_range,
                   float median_range)
{
    const Volume fine_range = range_of(fine), range = range_of(wide), top = top_of(wide);
    return make(cost.width, cost.height, 1, [&](int x, int y, unsigned) {
        const float share = 4.0f * silence(fine_range.at(x, y), median_fine_range);
        const auto value = [&](unsigned z) {
            return cost.at(x, y, z) + share * coarse_cost(wide, top, range, median_range, x, y, z);
        };
        unsigned best = 0;
        for (unsigned z = 1; z < cost.planes; z++)
            if (value(z) < value(best))
                best = z;
        return static_cast<float>(best);
    });
}

Volume nearest_3x3(const Volume &u)
{
    return like(u, [&](int x, int y, unsigned) {
        float least = at(u, x, y);
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++)
                least = std::min(least, at(u, x + i, y + j));
        return least;
    });
}

Volume median_5x5(const Volume &u)
{
    return like(u, [&](int x, int y, unsigned) {
        std::vector<float> around(25);
        for (int k = 0; k < 25; k++)
            around[k] = at(u, x + k % 5 - 2, y + k / 5 - 2);
        return median(around);
    });
}

Colours blend(const Colours &small, const Volume &u, float t)
{
    const float s = 0.6f + 0.3f * t;
    const auto blend_colour = [&](const Volume &colour) {
        return like(u, [&](int x, int y, unsigned) {
            float sum = 0.0f, weights = 0.0f;
            for (unsigned z = 0; z < colour.planes; z++) {
                const float d = static_cast<float>(z) - u.at(x, y),
                            weight = std::exp(-d * d / (2.0f * s * s));
                sum += weight * colour.at(x, y, z);
                weights += weight;
            }
            return sum / weights;
        });
    };
    return {blend_colour(small[0]), blend_colour(small[1]), blend_colour(small[2])};
}

Colours denoise(const Colours &guide, float sigma, unsigned scale)
{
    if (sigma <= 0.3f)
        return guide;
    const float range = 4.0f * sigma / static_cast<float>(scale);
    const auto denoise_colour = [&](const Volume &colour) {
        return like(colour, [&](int x, int y, unsigned) {
            float sum = 0.0f, weights = 0.0f;
            for (int j = -4; j <= 4; j++)
                for (int i = -4; i <= 4; i++) {
                    if (i * i + j * j > 16)
                        continue;
                    const float e =
                        std::min(distance(guide, x, y, guide, x + i, y + j) / (4.0f * range), 1.0f);
                    const float weight = std::exp(-(i * i + j * j) / 8.0f) * std::pow(1.0f - e * e, 8.0f);
                    sum += weight * at(colour, x + i, y + j);
                    weights += weight;
                }
            return sum / weights;
        });
    };
    return {denoise_colour(guide[0]), denoise_colour(guide[1]), denoise_colour(guide[2])};
}

} // namespace dff::twin
