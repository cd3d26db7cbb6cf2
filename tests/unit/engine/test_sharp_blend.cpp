/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/aif_composer.h"
#include "twin_sharp.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>

using namespace dff;

namespace {

/* Depth pixels of unit=index in smooth waves through all planes, a blot of them without a value. */
std::vector<uint16_t> waves(const StackShape &shape)
{
    const DepthEncoder encoder = DepthEncoder::index(shape.planes);
    std::vector<uint16_t> depth;
    for (unsigned y = 0; y < shape.height; y++)
        for (unsigned x = 0; x < shape.width; x++) {
            const double u = 0.5 * (shape.planes - 1) * (1.0 + std::sin(0.05 * x + 0.03 * y));
            depth.push_back(x > 20 && x < 31 && y > 9 && y < 24 ? 0 : encoder.encode(u));
        }
    return depth;
}

std::vector<std::byte> compose(const TestStack &stack, const std::vector<uint16_t> &depth)
{
    const StackShape &shape = stack.shape;
    const std::vector<RowLayout> layout = packed_layout({shape.format, shape.width, shape.height, 1});
    std::vector<std::byte> picture(stack.memory.size() / shape.planes);
    AifComposer composer(Device::open(""), shape);
    composer.compose(stack.view(), {std::as_bytes(std::span(depth)), shape.width * sizeof(uint16_t)},
                     AifComposer::Blend::Sharp, picture, layout);
    return picture;
}

/* Sample (x, y) of a picture in packed layout. */
double sample_of(const std::vector<std::byte> &picture, const StackShape &shape, size_t component, unsigned x,
                 unsigned y)
{
    const RowLayout rows = packed_layout({shape.format, shape.width, shape.height, 1})[component];
    const uint32_t bytes = shape.components()[component].sample_bytes;
    const std::byte *sample = picture.data() + rows.offset + rows.stride * y + x * bytes;
    return static_cast<double>(sample[0]) + (bytes == 2 ? 256.0 * static_cast<double>(sample[1]) : 0.0);
}

constexpr unsigned side = 256, plane_count = 5;

/* Gray planes of a picture that is sharp in plane `sharp_in` and blurred by boxes of 1 + 2 * 4 pixels a
 * plane, thrice, elsewhere. */
TestStack blurred_planes(const std::function<double(unsigned, unsigned)> &picture, unsigned sharp_in)
{
    TestStack stack({PixelFormat::Gray8, side, side, plane_count});
    for (unsigned z = 0; z < plane_count; z++) {
        const int radius = 4 * std::abs(static_cast<int>(z) - static_cast<int>(sharp_in));
        std::vector<double> plane;
        for (unsigned i = 0; i < side * side; i++)
            plane.push_back(picture(i % side, i / side));
        for (int pass = 0; pass < 6; pass++) { /* along rows, along columns, thrice */
            const std::vector<double> before = plane;
            for (int i = 0; i < static_cast<int>(plane.size()); i++) {
                const int x = i % static_cast<int>(side), y = i / static_cast<int>(side);
                double sum = 0.0;
                for (int k = -radius; k <= radius; k++)
                    sum += pass % 2 ? before[std::clamp(y + k, 0, 255) * side + x]
                                    : before[y * side + std::clamp(x + k, 0, 255)];
                plane[i] = sum / (2 * radius + 1);
            }
        }
        for (unsigned i = 0; i < side * side; i++)
            stack.memory[stack.layout[z].offset + i] = static_cast<std::byte>(std::lround(plane[i]));
    }
    return stack;
}

/* Bright bars, 40 pixels apart, on dark ground. */
double bars(unsigned x, unsigned y)
{
    return x / 8 % 5 == 2 && y > 40 && y < 216 ? 220.0 : 30.0;
}

/* Central differences along both directions, at a pixel that is not at the border. */
double gradient_at(const std::function<double(unsigned)> &sample, unsigned i)
{
    return std::hypot(sample(i + 1) - sample(i - 1), sample(i + side) - sample(i - side)) / 2.0;
}

} // namespace

/* Where the skirt of a blurred edge is steeper than what is sharp there, the picture used to change over to
 * it. */
TEST(SharpBlend, draws_no_line_that_no_plane_has)
{
    const TestStack stack = blurred_planes(bars, 2);
    const DepthEncoder encoder = DepthEncoder::index(plane_count);
    std::vector<uint16_t> depth; /* a plane off at the top and at the bottom */
    for (unsigned i = 0; i < side * side; i++)
        depth.push_back(encoder.encode(1.0 + 2.0 * i / (side * side)));
    const std::vector<std::byte> picture = compose(stack, depth);

    size_t lines = 0;
    for (unsigned y = 8; y < side - 8; y++)
        for (unsigned x = 8; x < side - 8; x++) {
            double steepest = 0.0;
            for (unsigned z = 0; z < plane_count; z++)
                for (unsigned j = y - 2; j <= y + 2; j++)
                    for (unsigned i = x - 2; i <= x + 2; i++)
                        steepest = std::max(
                            steepest,
                            gradient_at([&](unsigned k) { return stack.sample(0, k % side, k / side, z); },
                                        j * side + i));
            lines += gradient_at([&](unsigned k) { return static_cast<double>(picture[k]); }, y * side + x) >
                     1.3 * steepest + 1.5;
        }
    EXPECT_EQ(lines, 0);
}

TEST(SharpBlend, bright_bars_have_no_halo_where_the_depth_follows_their_blur)
{
    const TestStack stack = blurred_planes(bars, 2);
    const DepthEncoder encoder = DepthEncoder::index(plane_count);
    std::vector<uint16_t> depth; /* right on the bars, two planes off between them */
    for (unsigned i = 0; i < side * side; i++)
        depth.push_back(encoder.encode(bars(i % side, i / side) > 100.0 ? 2.0 : 3.5));
    const std::vector<std::byte> picture = compose(stack, depth);

    double worst = 0.0;
    for (unsigned y = 60; y < 196; y++)
        for (unsigned x = 48; x < 208; x++)
            worst = std::max(worst, std::abs(static_cast<double>(picture[y * side + x]) - bars(x, y)));
    EXPECT_LE(worst, 8.0);
}

/* Where the skirt that a bright shape has in a far plane is wider than what a band looked at, bands of
 * different planes added up to a dark rim. */
TEST(SharpBlend, what_lies_beside_a_bright_shape_is_no_darker)
{
    const auto block = [](unsigned x, unsigned y) {
        return x > 100 && x < 156 && y > 100 && y < 156 ? 220.0 : 30.0;
    };
    const TestStack stack = blurred_planes(block, 2);
    const std::vector<uint16_t> depth(side * side, DepthEncoder::index(plane_count).encode(2.0));
    const std::vector<std::byte> picture = compose(stack, depth);

    double darkest = 255.0;
    for (const std::byte pixel : picture)
        darkest = std::min(darkest, static_cast<double>(pixel));
    EXPECT_GE(darkest, 30.0 - 3.0);
}

/* Cells are 2 pixels wide: an edge between two of them once seemed no sharper than where it is blurred. */
TEST(SharpBlend, edges_are_as_sharp_wherever_they_lie)
{
    for (unsigned offset = 0; offset < 4; offset++) {
        const auto step = [&](int x) { return x / 40 % 2 ? 220.0 : 30.0; };
        TestStack stack({PixelFormat::Gray8, side, side, 3});
        for (unsigned z = 0; z < 3; z++) /* blurred by a box of 3 pixels in the first and the last */
            for (unsigned i = 0; i < side * side; i++) {
                const int x = static_cast<int>(i % side + offset), reach = z == 1 ? 0 : 1;
                stack.memory[stack.layout[z].offset + i] =
                    static_cast<std::byte>(std::lround((step(x - reach) + step(x) + step(x + reach)) / 3.0));
            }
        const std::vector<uint16_t> depth(side * side, DepthEncoder::index(3).encode(1.0));
        const std::vector<std::byte> picture = compose(stack, depth);

        double worst = 0.0;
        for (unsigned i = 0; i < side * side; i++)
            worst = std::max(
                worst, std::abs(static_cast<double>(picture[i]) - stack.sample(0, i % side, i / side, 1)));
        EXPECT_LE(worst, 8.0) << offset;
    }
}

class SharpStacks : public testing::TestWithParam<StackShape> {};

TEST_P(SharpStacks, agree_with_their_twin)
{
    const StackShape shape = GetParam();
    const TestStack stack(shape);
    const std::vector<uint16_t> depth = waves(shape);
    const std::vector<std::byte> picture = compose(stack, depth);

    const DepthEncoder encoder = DepthEncoder::index(shape.planes);
    std::vector<double> positions;
    positions.reserve(depth.size());
    for (const uint16_t pixel : depth)
        positions.push_back(encoder.decode(pixel).value_or(-1.0));
    const std::vector<std::vector<double>> twin = twin::sharp_picture(stack, positions);
    for (size_t c = 0; c < twin.size(); c++) {
        const Component component = shape.components()[c];
        const double unit = component.sample_bytes == 2 ? 256.0 : 1.0;
        for (unsigned y = 0; y < component.height; y++)
            for (unsigned x = 0; x < component.width; x++)
                ASSERT_NEAR(sample_of(picture, shape, c, x, y) / unit,
                            twin[c][y * component.width + x] / unit, 1.0)
                    << x << "," << y << " component " << c;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Sharp, SharpStacks,
    testing::Values(StackShape{PixelFormat::Gray8, 67, 65, 7}, StackShape{PixelFormat::Gray16, 67, 65, 7},
                    StackShape{PixelFormat::I420, 67, 65, 7}, StackShape{PixelFormat::Nv12, 67, 65, 7},
                    StackShape{PixelFormat::Rgb, 67, 65, 7}, StackShape{PixelFormat::Bgr, 64, 64, 2},
                    StackShape{PixelFormat::Rgbx, 67, 65, 7}, StackShape{PixelFormat::Bgrx, 129, 70, 3},
                    StackShape{PixelFormat::I420, 96, 64, 2}, StackShape{PixelFormat::Gray8, 65, 127, 64},
                    StackShape{PixelFormat::Nv12, 81, 97, 5}, StackShape{PixelFormat::Rgba64, 67, 65, 7},
                    StackShape{PixelFormat::Rgba64, 129, 70, 3}));
