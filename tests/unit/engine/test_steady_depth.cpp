/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/steady_depth.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <random>

using namespace dff;

namespace {

constexpr uint32_t width = 132, height = 100, planes = 4;
constexpr int left = 40, right = 80, top = 24, bottom = 64; /* what moves */

/* A picture with noise; between left and right it is moved by `shift`. */
class Scene {
public:
    explicit Scene(PixelFormat format)
        : shape{format, width, height, planes}, memory_(bytes_of(shape)), depth(size_t{width} * height)
    {
    }

    StackView draw(double sigma, unsigned seed, double shift = 0.0)
    {
        std::mt19937 random(seed);
        std::normal_distribution<double> noise(0.0, sigma);
        const Component component = shape.components().front();
        const auto layout = packed_layout(shape);
        for (uint32_t z = 0; z < planes; z++)
            for (uint32_t y = 0; y < height; y++)
                for (uint32_t i = 0; i < component.width; i++) {
                    const int x = static_cast<int>(i / component.channels), row = static_cast<int>(y);
                    const bool moves = x >= left && x < right && row >= top && row < bottom;
                    const double place = x + (moves ? shift : 0.0);
                    const double value =
                        120 + 60 * std::sin(0.5 * place) * std::cos(0.3 * row + z) + noise(random);
                    const double unit = component.sample_bytes == 2 ? 256.0 : 1.0;
                    const auto sample = static_cast<uint16_t>(std::clamp(unit * value, 0.0, 255.0 * unit));
                    std::memcpy(memory_.data() + layout[z].offset + y * layout[z].stride +
                                    size_t{i} * component.sample_bytes,
                                &sample, component.sample_bytes);
                }
        return {shape, memory_, layout};
    }

    void set_depth(double mean, double sigma, unsigned seed)
    {
        std::mt19937 random(seed);
        std::normal_distribution<double> noise(mean, sigma);
        for (uint16_t &pixel : depth)
            pixel = static_cast<uint16_t>(noise(random));
    }

    DepthRows rows() { return {reinterpret_cast<std::byte *>(depth.data()), width * sizeof(uint16_t)}; }

    StackShape shape;

private:
    std::vector<std::byte> memory_;

public:
    std::vector<uint16_t> depth;
};

DepthJumps jumps_of(uint16_t all)
{
    DepthJumps jumps;
    jumps.fill(all);
    return jumps;
}

double spread(const std::vector<uint16_t> &depth, double mean)
{
    double sum = 0.0;
    for (const uint16_t pixel : depth)
        sum += (pixel - mean) * (pixel - mean);
    return std::sqrt(sum / static_cast<double>(depth.size()));
}

class SteadyDepthFormats : public testing::TestWithParam<PixelFormat> {};

} // namespace

TEST_P(SteadyDepthFormats, depth_of_a_still_scene_comes_to_rest)
{
    for (const double sigma : {0.0, 8.0}) {
        Scene scene(GetParam());
        SteadyDepth steady(scene.shape);
        for (unsigned t = 0; t < 16; t++) {
            const StackView stack = scene.draw(sigma, t);
            scene.set_depth(20000, 500, t);
            steady.steady(stack, scene.rows(), jumps_of(4000));
        }
        EXPECT_LT(spread(scene.depth, 20000), 500 / 4.0 * 1.1) << "noise " << sigma;
    }
}

TEST_P(SteadyDepthFormats, what_moves_has_the_depth_of_the_last_stack)
{
    for (const double sigma : {0.0, 4.0}) {
        Scene scene(GetParam());
        SteadyDepth steady(scene.shape);
        for (unsigned t = 0; t < 8; t++) {
            const StackView stack = scene.draw(sigma, t, t);
            scene.set_depth(20000 + 100.0 * t, 300, t);
            const auto now = scene.depth;
            steady.steady(stack, scene.rows(), jumps_of(4000));
            for (int y = top; y < bottom; y++)
                for (int x = left; x < right; x++) {
                    const size_t i = static_cast<size_t>(y) * width + static_cast<size_t>(x);
                    ASSERT_EQ(scene.depth[i], now[i]) << x << " " << y << " in " << t;
                }
        }
        EXPECT_NE(scene.depth[0], 0U);
        EXPECT_LT(spread({scene.depth.begin(), scene.depth.begin() + width}, 20350), 250);
    }
}

INSTANTIATE_TEST_SUITE_P(SteadyDepth, SteadyDepthFormats,
                         testing::Values(PixelFormat::Gray8, PixelFormat::Gray16, PixelFormat::I420,
                                         PixelFormat::Rgb));

TEST(SteadyDepth, a_jump_in_a_still_picture_is_believed_when_it_lasts)
{
    Scene scene(PixelFormat::Gray8);
    SteadyDepth steady(scene.shape);
    std::vector<uint16_t> seen;
    for (const double depth : {20000, 20000, 30000, 20000, 30000, 30000, 30000, 30000}) {
        const StackView stack = scene.draw(2.0, static_cast<unsigned>(seen.size()));
        scene.set_depth(depth, 0, 0);
        steady.steady(stack, scene.rows(), jumps_of(4000));
        seen.push_back(scene.depth[5]);
    }
    EXPECT_EQ(seen, (std::vector<uint16_t>{20000, 20000, 20000, 20000, 20000, 20000, 20000, 30000}));
}

TEST(SteadyDepth, no_value_stays_none_and_a_new_scene_begins_anew)
{
    Scene scene(PixelFormat::Gray8);
    SteadyDepth steady(scene.shape);
    std::vector<uint16_t> seen;
    for (const double depth : {20000, 0, 20100, 20300}) {
        const StackView stack = scene.draw(2.0, static_cast<unsigned>(seen.size()));
        scene.set_depth(depth, 0, 0);
        if (seen.size() == 3)
            steady.forget();
        steady.steady(stack, scene.rows(), jumps_of(4000));
        seen.push_back(scene.depth[5]);
    }
    EXPECT_EQ(seen, (std::vector<uint16_t>{20000, 0, 20100, 20300}));
}
