/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/aif_composer.h"
#include "test_stack.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

using namespace dff;

namespace {

/* Depth pixels of unit=index that run through all positions, one in seven without a value if there are
 * `holes`. */
std::vector<uint16_t> test_depth(const StackShape &shape, bool holes = true)
{
    const DepthEncoder encoder = DepthEncoder::index(shape.planes);
    std::vector<uint16_t> depth;
    for (unsigned i = 0; i < shape.width * shape.height; i++)
        depth.push_back(holes && i % 7 == 0 ? 0 : encoder.encode((shape.planes - 1) * (i % 101) / 100.0));
    return depth;
}

/* The twin of soften_depth.cl. */
std::vector<uint16_t> softened(const std::vector<uint16_t> &depth, const StackShape &shape)
{
    const int width = static_cast<int>(shape.width), height = static_cast<int>(shape.height);
    const auto for_each_around = [&](int x, int y, const auto &work) {
        for (int j = -1; j <= 1; j++)
            for (int i = x == 0 || x == width - 1 ? 0 : -1; i <= (x == 0 || x == width - 1 ? 0 : 1); i++)
                work((x == 0 || x == width - 1 ? y : std::clamp(y + j, 0, height - 1)) * width + x + i);
    };
    std::vector<uint16_t> nearest, result;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            uint16_t least = 65535;
            for_each_around(x, y, [&](int i) { least = std::min<uint16_t>(least, depth[i] - 1); });
            nearest.push_back(least);
        }
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const uint16_t own = nearest[y * width + x];
            double sum = 0.0, count = 0.0;
            for_each_around(x, y, [&](int i) {
                sum += nearest[i] == 65535 ? own : nearest[i];
                count++;
            });
            result.push_back(depth[y * width + x] == 0 ? 0
                                                       : static_cast<uint16_t>(1 + std::lround(sum / count)));
        }
    return result;
}

/* The twin of aif.cl's position_of. */
double position_of(const std::vector<uint16_t> &depth, const StackShape &shape, const Component &c,
                   unsigned x, unsigned y)
{
    const DepthEncoder encoder = DepthEncoder::index(shape.planes);
    double sum = 0.0;
    unsigned known = 0;
    for (unsigned j = y * c.subsampling; j < std::min((y + 1) * c.subsampling, shape.height); j++)
        for (unsigned i = x * c.subsampling; i < std::min((x + 1) * c.subsampling, shape.width); i++)
            if (const auto u = encoder.decode(depth[j * shape.width + i])) {
                sum += *u;
                known++;
            }
    return known ? sum / known : -1.0;
}

/* Planes without noise, none like another: Immerkaer's filter sees no slope. */
TestStack quiet_stack(const StackShape &shape)
{
    TestStack stack(shape);
    const std::vector<Component> components = shape.components();
    for (size_t c = 0; c < components.size(); c++)
        for (unsigned z = 0; z < shape.planes; z++)
            for (unsigned y = 0; y < components[c].height; y++)
                for (unsigned x = 0; x < components[c].width; x++) {
                    const RowLayout &rows = stack.layout[c * shape.planes + z];
                    const size_t first = rows.offset + rows.stride * y + components[c].sample_bytes * x;
                    for (unsigned byte = 0; byte < components[c].sample_bytes; byte++)
                        stack.memory[first + byte] =
                            static_cast<std::byte>(20 + 30 * (z % 3) + 7 * z + y / 4);
                }
    return stack;
}

enum class Kind { Noisy, Quiet };

double twin_sample(const std::vector<double> &planes, double u, AifComposer::Blend blend, Kind kind)
{
    if (kind == Kind::Quiet && u >= 0.0) {
        const size_t z = std::min(static_cast<size_t>(u), planes.size() - 2);
        const double s = u - static_cast<double>(z), share = std::clamp(1.5 * s - 0.25, 0.0, 1.0);
        return planes[z] + share * (planes[z + 1] - planes[z]);
    }
    const auto count = static_cast<int>(planes.size());
    double sum = 0.0, weights = 0.0;
    for (int z = 0; z < count; z++) {
        double weight = 1.0;
        if (u >= 0.0 && blend == AifComposer::Blend::Linear)
            weight = std::max(1.0 - std::abs(z - u), 0.0);
        else if (u >= 0.0)
            weight = z >= static_cast<int>(u) - 2 && z <= static_cast<int>(u) + 3
                         ? std::exp(-(z - u) * (z - u) / (2.0 * 0.36))
                         : 0.0;
        sum += weight * planes[z];
        weights += weight;
    }
    return sum / weights;
}

} // namespace

class AifFormats
    : public testing::TestWithParam<std::tuple<PixelFormat, AifComposer::Blend, KernelStyle, bool>> {
protected:
    static void expect_twin(const TestStack &stack, Kind kind, const std::vector<uint16_t> &depth);
    static void expect_twin(const TestStack &stack, Kind kind)
    {
        expect_twin(stack, kind, test_depth(stack.shape, std::get<bool>(GetParam())));
    }
};

TEST_P(AifFormats, agrees_with_its_twin)
{
    expect_twin(TestStack({std::get<PixelFormat>(GetParam()), 67, 65, 7}), Kind::Noisy);
}

TEST_P(AifFormats, without_noise_the_nearer_plane_counts_more)
{
    expect_twin(quiet_stack({std::get<PixelFormat>(GetParam()), 67, 65, 7}), Kind::Quiet);
}

/* Between the same two planes along each row, from the first plane's place to the last one's. */
TEST_P(AifFormats, depth_that_falls_from_row_to_row_agrees_too)
{
    const TestStack stack({std::get<PixelFormat>(GetParam()), 67, 65, 7});
    std::vector<uint16_t> depth;
    for (unsigned y = 0; y < 65; y++)
        for (unsigned x = 0; x < 67; x++)
            depth.push_back(std::get<bool>(GetParam()) && (x + y) % 29 == 0
                                ? uint16_t{0}
                                : static_cast<uint16_t>(1 + 65531 * y / 64 + x % 3));
    expect_twin(stack, Kind::Noisy, depth);
}

void AifFormats::expect_twin(const TestStack &stack, Kind kind, const std::vector<uint16_t> &depth)
{
    const auto [format, blend, style, holes] = GetParam();
    const std::vector<uint16_t> taken_at = softened(depth, stack.shape);
    const std::vector<RowLayout> layout = packed_layout({format, 67, 65, 1});
    std::vector<std::byte> picture(stack.memory.size() / 7);
    AifComposer composer(device_with(style), stack.shape);
    composer.compose(stack.view(), {std::as_bytes(std::span(depth)), 67 * 2}, blend, picture, layout);

    const std::vector<Component> components = stack.shape.components();
    for (size_t c = 0; c < components.size(); c++)
        for (unsigned y = 0; y < components[c].height; y++)
            for (unsigned x = 0; x < components[c].width; x++) {
                const double u =
                    position_of(taken_at, stack.shape, components[c], x / components[c].channels, y);
                std::vector<double> planes;
                for (unsigned z = 0; z < 7; z++)
                    planes.push_back(stack.value(c, x, y, z));
                const std::byte *sample =
                    picture.data() + layout[c].offset + layout[c].stride * y + x * components[c].sample_bytes;
                double found = static_cast<double>(sample[0]);
                if (sample_bytes(format) == 2)
                    found += 256.0 * static_cast<double>(sample[1]);
                /* Rounding; in tiles, positions are rounded to 1/256 plane too. */
                const double of_8_bits = style == KernelStyle::Pixels ? 0.55 : 1.05;
                const double tolerance = sample_bytes(format) == 2 ? 8.0 : of_8_bits;
                ASSERT_NEAR(found, twin_sample(planes, u, blend, kind), tolerance)
                    << x << "," << y << " component " << c;
            }
}

INSTANTIATE_TEST_SUITE_P(
    Aif, AifFormats,
    testing::Combine(testing::Values(PixelFormat::Gray8, PixelFormat::Gray16, PixelFormat::I420,
                                     PixelFormat::Nv12, PixelFormat::Rgb, PixelFormat::Bgr, PixelFormat::Rgbx,
                                     PixelFormat::Bgrx, PixelFormat::Rgba64),
                     testing::Values(AifComposer::Blend::Linear, AifComposer::Blend::Soft),
                     testing::Values(KernelStyle::Pixels, KernelStyle::Tiles), testing::Bool()));
