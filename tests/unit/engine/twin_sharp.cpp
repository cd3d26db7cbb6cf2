/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "twin_sharp.h"

#include "twin_focus.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace dff::twin {

namespace {

constexpr int top_level = 5;
constexpr double reach = 2.5, floor_dn = 0.1;

/* A picture beyond whose borders stand its borders. */
class Picture {
public:
    Picture(int width, int height, const std::function<double(int, int)> &value)
        : width_(width), height_(height), values_(static_cast<size_t>(width) * height)
    {
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++)
                values_[static_cast<size_t>(y) * width + x] = value(x, y);
    }

    int width() const { return width_; }
    int height() const { return height_; }
    double at(int x, int y) const
    {
        return values_[static_cast<size_t>(std::clamp(y, 0, height_ - 1)) * width_ +
                       std::clamp(x, 0, width_ - 1)];
    }
    const std::vector<double> &values() const { return values_; }

    /* Of as many cells: value(x, y). */
    Picture like(const std::function<double(int, int)> &value) const { return {width_, height_, value}; }

    /* Of half as many: value(x, y), (x, y) the first of the four. */
    Picture half(const std::function<double(int, int)> &value) const
    {
        return {(width_ + 1) / 2, (height_ + 1) / 2, [&](int x, int y) { return value(2 * x, 2 * y); }};
    }

private:
    int width_, height_;
    std::vector<double> values_;
};

using Planes = std::vector<Picture>;

double gradient(const Picture &luma, int x, int y)
{
    double dx = 0.0, dy = 0.0;
    for (int i = -1; i <= 1; i++) {
        dx += (2 - std::abs(i)) * (luma.at(x + 1, y + i) - luma.at(x - 1, y + i)) / 8.0;
        dy += (2 - std::abs(i)) * (luma.at(x + i, y + 1) - luma.at(x + i, y - 1)) / 8.0;
    }
    return std::max(std::abs(dx), std::abs(dy)) + 0.375 * std::min(std::abs(dx), std::abs(dy));
}

Picture dilated(const Picture &sharpness, int radius)
{
    return sharpness.like([&](int x, int y) {
        double most = 0.0;
        for (int j = -radius; j <= radius; j++)
            for (int i = -radius; i <= radius; i++)
                most = std::max(most, sharpness.at(x + i, y + j));
        return most;
    });
}

Picture softened(const Picture &sharpness)
{
    constexpr double binomial[5] = {1.0 / 16, 4.0 / 16, 6.0 / 16, 4.0 / 16, 1.0 / 16};
    return sharpness.like([&](int x, int y) {
        double sum = 0.0;
        for (int j = -2; j <= 2; j++)
            for (int i = -2; i <= 2; i++)
                sum += binomial[i + 2] * binomial[j + 2] * sharpness.at(x + i, y + j);
        return sum;
    });
}

/* A level's cell (x, y) from the next level. */
double upsampled(const Picture &coarse, int x, int y)
{
    const int beside_x = x % 2 ? x / 2 + 1 : x / 2 - 1, beside_y = y % 2 ? y / 2 + 1 : y / 2 - 1;
    return 0.5625 * coarse.at(x / 2, y / 2) +
           0.1875 * (coarse.at(beside_x, y / 2) + coarse.at(x / 2, beside_y)) +
           0.0625 * coarse.at(beside_x, beside_y);
}

/* The nearest of four positions that are known. */
double nearest_of(const Picture &positions, int x, int y)
{
    double least = 1e9;
    for (const auto &[i, j] : {std::pair(0, 0), {1, 0}, {0, 1}, {1, 1}})
        if (positions.at(x + i, y + j) >= 0.0)
            least = std::min(least, positions.at(x + i, y + j));
    return least < 1e9 ? least : -1.0;
}

/* Weights of one cell in all planes, in whole parts of 255. */
std::vector<double> weights_at(const Planes &sharpness, double u, double power, int x, int y)
{
    std::vector<double> weights;
    const auto near = [&](size_t z) {
        return u < 0.0 ? 1.0 : std::max(1.0 - std::abs(static_cast<double>(z) - u) / reach, 0.0);
    };
    double sharpest = 0.0, sum = 0.0;
    for (size_t z = 0; z < sharpness.size(); z++)
        if (near(z) > 0.0)
            sharpest = std::max(sharpest, sharpness[z].at(x, y) + floor_dn);
    for (size_t z = 0; z < sharpness.size(); z++) {
        const double share = std::min((sharpness[z].at(x, y) + floor_dn) / sharpest, 1.0);
        weights.push_back(near(z) * std::pow(share, power));
        sum += weights.back();
    }
    for (double &weight : weights)
        weight = std::floor(255.0 * weight / sum + 0.5);
    return weights;
}

/* The sharpness as many cells around, of every plane. */
Planes around(const Planes &sharpness, int radius)
{
    Planes result;
    for (const Picture &f : sharpness)
        result.push_back(softened(dilated(f, radius)));
    return result;
}

/* Weights of every plane. */
Planes band_weights(const Planes &around, const Picture &u, double power)
{
    std::vector<std::vector<double>> cells;
    for (int y = 0; y < u.height(); y++)
        for (int x = 0; x < u.width(); x++)
            cells.push_back(weights_at(around, u.at(x, y), power, x, y));
    Planes result;
    for (size_t z = 0; z < around.size(); z++)
        result.push_back(u.like([&](int x, int y) { return cells[y * u.width() + x][z]; }));
    return result;
}

/* Of level 1. */
Picture sharpness_of(const Picture &luma)
{
    return luma.half([&](int x, int y) {
        const double a = gradient(luma, x, y), b = gradient(luma, x + 1, y), c = gradient(luma, x, y + 1),
                     d = gradient(luma, x + 1, y + 1);
        return 0.75 * (a + b + c + d) / 4.0 + 0.25 * std::max({a, b, c, d});
    });
}

/* Weights of every band; those of the finest one lie in cells of level 1. */
std::vector<Planes> weights(const Volume &luma, const std::vector<double> &positions)
{
    const int width = static_cast<int>(luma.width), height = static_cast<int>(luma.height);
    std::vector<Planes> sharpness(top_level + 1);
    for (unsigned z = 0; z < luma.planes; z++)
        sharpness[1].push_back(
            sharpness_of(Picture(width, height, [&](int x, int y) { return luma.at(x, y, z); })));
    for (int level = 2; level <= top_level; level++)
        for (const Picture &f : sharpness[level - 1])
            sharpness[level].push_back(f.half([&](int x, int y) {
                return std::max({f.at(x, y), f.at(x + 1, y), f.at(x, y + 1), f.at(x + 1, y + 1)});
            }));
    const Picture pixels(width, height, [&](int x, int y) { return positions[y * width + x]; });
    std::vector<Picture> u{pixels};
    for (int level = 1; level <= top_level; level++)
        u.push_back(u.back().half([&](int x, int y) { return nearest_of(u.back(), x, y); }));

    std::vector<Planes> result(top_level + 1);
    result[0] = band_weights(around(sharpness[1], 1), u[1], 64.0);
    Planes above;
    for (int level = top_level; level > 0; level--) {
        Planes here = around(sharpness[level], 2);
        for (size_t z = 0; z < above.size(); z++)
            here[z] = here[z].like(
                [&](int x, int y) { return std::max(here[z].at(x, y), 0.5 * upsampled(above[z], x, y)); });
        result[level] = band_weights(here, u[level], 32.0);
        above = here;
    }
    return result;
}

Picture shrunk(const Picture &picture)
{
    constexpr double weights[4] = {1.0 / 8, 3.0 / 8, 3.0 / 8, 1.0 / 8};
    return picture.half([&](int x, int y) {
        double sum = 0.0;
        for (int j = 0; j < 4; j++)
            for (int i = 0; i < 4; i++)
                sum += weights[i] * weights[j] * picture.at(x - 1 + i, y - 1 + j);
        return sum;
    });
}

/* One channel of a component whose samples are the cells of level `first`. */
Picture blend(const Planes &planes, const std::vector<Planes> &weights, int first)
{
    std::vector<Planes> levels(first);
    levels.push_back(planes);
    for (int level = first + 1; level <= top_level; level++) {
        levels.push_back({});
        for (const Picture &plane : levels[level - 1])
            levels[level].push_back(shrunk(plane));
    }
    Picture result = levels[top_level][0];
    for (int level = top_level; level >= first; level--) {
        const Picture coarse = result;
        result = levels[level][0].like([&](int x, int y) {
            double sum = 0.0, total = 0.0;
            for (size_t z = 0; z < planes.size(); z++) {
                const double weight =
                    level == 0 ? upsampled(weights[0][z], x, y) : weights[level][z].at(x, y);
                const double below = level == top_level ? 0.0 : upsampled(levels[level + 1][z], x, y);
                sum += weight * (levels[level][z].at(x, y) - below);
                total += weight;
            }
            return sum / total + (level == top_level ? 0.0 : upsampled(coarse, x, y));
        });
    }
    return result;
}

} // namespace

std::vector<std::vector<double>> sharp_picture(const TestStack &stack, const std::vector<double> &positions)
{
    const std::vector<Planes> bands = weights(luma(stack), positions);
    std::vector<std::vector<double>> result;
    for (const Component &c : stack.shape.components()) {
        const int channels = static_cast<int>(c.channels), width = static_cast<int>(c.width) / channels;
        const int height = static_cast<int>(c.height);
        std::vector<double> samples(static_cast<size_t>(c.width) * c.height);
        for (int k = 0; k < channels; k++) {
            Planes planes;
            for (unsigned z = 0; z < stack.shape.planes; z++)
                planes.push_back({width, height, [&](int x, int y) {
                                      return stack.value(result.size(), x * channels + k, y, z);
                                  }});
            const Picture picture = blend(planes, bands, c.subsampling == 2 ? 1 : 0);
            const double most = c.sample_bytes == 1 ? 255.0 : 65535.0;
            for (int y = 0; y < height; y++)
                for (int x = 0; x < width; x++)
                    samples[static_cast<size_t>(y) * c.width + x * channels + k] =
                        std::clamp(picture.at(x, y), 0.0, most);
        }
        result.push_back(samples);
    }
    return result;
}

} // namespace dff::twin
