/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The CPU's kernels against the same twins as the plain ones, within the bounds that kernels/cpu state. */
#include "engine/cpu/depth_slice.h"
#include "engine/cpu/focus_tiles.h"
#include "engine/gaussian_blur.h"
#include "engine/sparse_depth.h"
#include "twin_bilateral_grid.h"
#include "twin_focus.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>

using namespace dff;

namespace {

struct Stages {
    explicit Stages(const TestStack &stack, unsigned levels = 3, float entropy_bits = 2.0f)
        : queue(Device::open("")), buffer(queue, stack.shape), luma(queue, stack.shape),
          focus(queue, stack.shape, levels, 1.4f, entropy_bits)
    {
        buffer.assign(stack.view());
        luma.run(buffer);
    }

    CommandQueue queue;
    StackBuffer buffer;
    LumaPlanes luma;
    FocusTiles focus;
};

/* Texture a few pixels wide, as a lens leaves it, in planes of falling contrast. */
TestStack smooth_stack(const StackShape &shape)
{
    TestStack stack(shape);
    for (unsigned z = 0; z < shape.planes; z++)
        for (unsigned y = 0; y < shape.height; y++)
            for (unsigned x = 0; x < shape.width; x++) {
                const float texture = std::sin(0.9f * x + 0.002f * x * y) + std::sin(0.7f * y - 0.3f * x);
                const float sharpest = 0.5f * (shape.planes - 1) * (1.0f + std::sin(0.02f * x + 0.01f * y));
                const float contrast = 45.0f / (1.0f + std::abs(z - sharpest));
                const RowLayout &rows = stack.layout[z];
                stack.memory[rows.offset + rows.stride * y + x] = std::byte(128.0f + contrast * texture);
            }
    return stack;
}

float share_of(size_t part, size_t whole)
{
    return static_cast<float>(part) / static_cast<float>(whole);
}

/* Share of equal planes among the pixels that both keep, and share of pixels that only one keeps. */
struct Agreement {
    Agreement(const std::vector<uint8_t> &found, const std::vector<uint8_t> &expected)
    {
        size_t both = 0, one = 0, equal = 0;
        for (size_t i = 0; i < found.size(); i++) {
            const bool in_found = found[i] != SparseDepth::unknown_plane;
            const bool in_expected = expected[i] != SparseDepth::unknown_plane;
            both += in_found && in_expected;
            one += in_found != in_expected;
            equal += in_found && found[i] == expected[i];
        }
        same_plane = share_of(equal, both);
        kept_by_one = share_of(one, found.size());
    }

    float same_plane, kept_by_one;
};

} // namespace

struct FocusCase {
    unsigned width, height, planes, levels;
    float kept_by_one; /* more where the levels do not divide the size */
};

void PrintTo(const FocusCase &c, std::ostream *out)
{
    *out << c.width << "x" << c.height << "x" << c.planes << " levels " << c.levels;
}

class FocusTilesShapes : public testing::TestWithParam<FocusCase> {};

TEST_P(FocusTilesShapes, agree_with_the_twin)
{
    const FocusCase &c = GetParam();
    const TestStack stack = smooth_stack({PixelFormat::Gray8, c.width, c.height, c.planes});
    Stages stages(stack, c.levels);
    stages.focus.run(stages.luma, false, true);

    const twin::Focus focus = twin::focus_product(twin::luma(stack), c.levels);
    const std::vector<uint8_t> expected = twin::sparse_depth(focus, nullptr, 1.4f);
    const size_t pixels = expected.size();
    const Agreement agreement(read_back<uint8_t>(stages.queue, stages.focus.places(), pixels), expected);
    EXPECT_GE(agreement.same_plane, c.planes > 16 ? 0.985f : 0.99f);
    EXPECT_LE(agreement.kept_by_one, c.kept_by_one);

    const auto confidence = read_back<uint8_t>(stages.queue, stages.focus.confidence(), pixels);
    size_t far_off = 0;
    for (size_t i = 0; i < pixels; i++) {
        const float peak = focus.peak.values[i];
        const float above = peak > 0.0f ? 1.0f - focus.mean.values[i] / peak : 0.0f;
        far_off += std::abs(confidence[i] - 255.0f * above * c.planes / (c.planes - 1)) > 8.0f;
    }
    EXPECT_LE(share_of(far_off, pixels), 0.07f);
}

TEST(CpuKernels, between_planes_that_are_equally_sharp_is_their_middle)
{
    for (const unsigned equal : {1u, 2u, 3u}) {
        const TestStack stack = stack_with_equal_planes(2, equal);
        Stages stages(stack);
        stages.focus.run(stages.luma, false, false);
        const size_t pixels = size_t{stack.shape.width} * stack.shape.height;
        const auto places = read_back<uint8_t>(stages.queue, stages.focus.places(), pixels);
        EXPECT_GT(std::ranges::count(places, 2 * 2 + equal - 1), pixels / 20);
        EXPECT_EQ(std::ranges::count(places, 2 * 2 + equal - 1) +
                      std::ranges::count(places, SparseDepth::unknown_plane),
                  pixels);
    }
}

INSTANTIATE_TEST_SUITE_P(CpuKernels, FocusTilesShapes,
                         testing::Values(FocusCase{192, 144, 6, 3, 0.03f}, FocusCase{396, 84, 10, 3, 0.03f},
                                         FocusCase{2640, 72, 4, 3, 0.03f}, FocusCase{385, 73, 4, 3, 0.03f},
                                         FocusCase{65, 67, 5, 3, 0.03f}, FocusCase{240, 96, 64, 3, 0.03f},
                                         FocusCase{192, 96, 6, 1, 0.03f}, FocusCase{192, 96, 6, 2, 0.03f},
                                         FocusCase{192, 96, 6, 4, 0.03f}, FocusCase{193, 95, 6, 4, 0.03f}));

/* One tile, a last tile too narrow for the lanes, and one that is not. */
TEST(CpuKernels, statistics_agree_with_the_twins)
{
    for (const unsigned width : {97u, 385u, 450u})
        for (const float threshold : {0.5f, 1.0f, 2.0f}) {
            const TestStack stack({PixelFormat::Gray8, width, 66, 11}, 7);
            Stages stages(stack, 3, threshold);
            stages.focus.run(stages.luma, false, false);
            const Volume luma = twin::luma(stack);
            const size_t pixels = size_t{width} * 66;
            EXPECT_EQ(read_back<uint8_t>(stages.queue, stages.focus.mean(), pixels), twin::mean_luma(luma));
            EXPECT_EQ(read_back<uint8_t>(stages.queue, stages.focus.moved(), pixels),
                      twin::z_entropy(luma, threshold));
        }
}

class CpuFormats : public testing::TestWithParam<PixelFormat> {};

TEST_P(CpuFormats, luma_is_the_twins_rounded_to_8_bits)
{
    const TestStack stack({GetParam(), 71, 67, 3});
    Stages stages(stack);
    const Volume expected = twin::luma(stack);
    const auto rows = read_back<RowLayout>(stages.queue, stages.luma.rows(), 3);
    const auto bytes =
        read_back<uint8_t>(stages.queue, stages.luma.bytes(), rows[2].offset + rows[2].stride * 67);
    for (unsigned z = 0; z < 3; z++)
        for (unsigned y = 0; y < 67; y++)
            for (unsigned x = 0; x < 71; x++)
                ASSERT_NEAR(bytes[rows[z].offset + rows[z].stride * y + x], expected.at(x, y, z), 0.5f);
}

INSTANTIATE_TEST_SUITE_P(CpuKernels, CpuFormats,
                         testing::Values(PixelFormat::Gray8, PixelFormat::Gray16, PixelFormat::I420,
                                         PixelFormat::Nv12, PixelFormat::Rgb, PixelFormat::Bgr,
                                         PixelFormat::Rgbx, PixelFormat::Bgrx, PixelFormat::Rgba64));

class LumaGridParameters : public testing::TestWithParam<BilateralGrid::Parameters> {};

/* Solver and twin start differently and are compared where both have come to their end. */
TEST_P(LumaGridParameters, depth_agrees_with_the_twin)
{
    const StackShape shape{PixelFormat::Gray8, 150, 101, 6};
    const TestStack stack = smooth_stack(shape);
    Stages stages(stack);
    stages.focus.run(stages.luma, false, false);
    LumaGrid grid(stages.queue, 150, 101, GetParam());
    DepthSlice slice(stages.queue, shape, grid);
    const DepthCoder coder(stages.queue, shape);
    const size_t pixels = 150 * 101;
    const cl::Buffer depth = stages.queue.allocate(pixels * sizeof(uint16_t));
    grid.run(stages.focus.places(), stages.focus.mean());
    slice.run(grid, stages.focus.mean(), coder, depth);

    const auto sparse = read_back<uint8_t>(stages.queue, stages.focus.places(), pixels);
    const auto luma = read_back<uint8_t>(stages.queue, stages.focus.mean(), pixels);
    const Volume expected =
        twin::gaussian_blur(twin::bilateral_solve(sparse, luma, {}, {}, 150, 101, GetParam()),
                            GaussianBlur::taps_for(GetParam().sigma_xy));
    const auto found = read_back<uint16_t>(stages.queue, depth, pixels);
    size_t far_off = 0;
    for (size_t i = 0; i < pixels; i++)
        far_off += std::abs((found[i] - 1) / 65534.0f * 5.0f - expected.values[i]) > 5.0f / 255.0f;
    EXPECT_LE(share_of(far_off, pixels), 0.01f) << "within 1/255 of the range on 99 % of the pixels";
}

INSTANTIATE_TEST_SUITE_P(CpuKernels, LumaGridParameters,
                         testing::Values(BilateralGrid::Parameters{16, 16, 0, 0.1f, 300},
                                         BilateralGrid::Parameters{8, 32, 0, 0.1f, 300},
                                         BilateralGrid::Parameters{16, 16, 0, 2.0f, 500},
                                         BilateralGrid::Parameters{37, 5, 0, 0.1f, 300}));

TEST(CpuKernels, the_first_start_agrees_with_its_twin)
{
    const BilateralGrid::Parameters no_iterations{16, 16, 0, 0.1f, 0};
    const StackShape shape{PixelFormat::Gray8, 150, 101, 6};
    const TestStack stack = smooth_stack(shape);
    Stages stages(stack);
    stages.focus.run(stages.luma, false, false);
    LumaGrid grid(stages.queue, 150, 101, no_iterations);
    DepthSlice slice(stages.queue, shape, grid);
    const DepthCoder coder(stages.queue, shape);
    const size_t pixels = 150 * 101;
    const cl::Buffer depth = stages.queue.allocate(pixels * sizeof(uint16_t));
    grid.run(stages.focus.places(), stages.focus.mean());
    slice.run(grid, stages.focus.mean(), coder, depth);

    const Volume expected = twin::gaussian_blur(
        twin::spread_start(read_back<uint8_t>(stages.queue, stages.focus.places(), pixels),
                           read_back<uint8_t>(stages.queue, stages.focus.mean(), pixels), 150, 101,
                           no_iterations),
        GaussianBlur::taps_for(no_iterations.sigma_xy));
    const auto found = read_back<uint16_t>(stages.queue, depth, pixels);
    for (size_t i = 0; i < pixels; i++)
        ASSERT_NEAR((found[i] - 1) / 65534.0f * 5.0f, expected.values[i], 0.05f) << i;
}

/* Also on the outermost planes, below and above which there are no codes. */
TEST(CpuKernels, a_flat_scene_keeps_its_plane_to_16_bits)
{
    const StackShape shape{PixelFormat::Gray8, 150, 101, 6};
    const TestStack stack = smooth_stack(shape);
    Stages stages(stack);
    stages.focus.run(stages.luma, false, false);
    LumaGrid grid(stages.queue, 150, 101, {16, 16, 0, 0.1f, 300});
    DepthSlice slice(stages.queue, shape, grid);
    const DepthCoder coder(stages.queue, shape);
    const size_t pixels = 150 * 101;
    const cl::Buffer places = stages.queue.allocate(pixels);
    const cl::Buffer depth = stages.queue.allocate(pixels * sizeof(uint16_t));
    for (const uint8_t plane : {0, 2, 5}) {
        stages.queue.commands().enqueueFillBuffer(places, static_cast<uint8_t>(2 * plane), 0, pixels);
        grid.run(places, stages.focus.mean());
        slice.run(grid, stages.focus.mean(), coder, depth);
        for (const uint16_t pixel : read_back<uint16_t>(stages.queue, depth, pixels))
            ASSERT_NEAR(pixel, 1 + 65534 * plane / 5, 10);
    }
}

TEST(CpuKernels, a_grid_goes_on_from_the_last_solution_where_that_is_better)
{
    const StackShape shape{PixelFormat::Gray8, 150, 101, 6};
    const TestStack stack = smooth_stack(shape); /* used in place */
    Stages stages(stack);
    stages.focus.run(stages.luma, false, false);
    LumaGrid grid(stages.queue, 150, 101, {16, 16, 0, 0.1f, 6});
    const auto residual_of_run = [&] {
        grid.run(stages.focus.places(), stages.focus.mean());
        return read_back<float>(stages.queue, grid.residual_norm(), 1)[0];
    };
    const float first = residual_of_run();
    EXPECT_LT(residual_of_run(), 0.5f * first);
}

TEST(CpuKernels, a_grid_works_again_after_nothing_was_known)
{
    const StackShape shape{PixelFormat::Gray8, 96, 80, 4};
    TestStack blank(shape);
    std::fill(blank.memory.begin(), blank.memory.end(), std::byte{90});
    const TestStack stack = smooth_stack(shape);
    Stages stages(blank);
    LumaGrid grid(stages.queue, 96, 80, {});
    DepthSlice slice(stages.queue, shape, grid);
    const DepthCoder coder(stages.queue, shape);
    const cl::Buffer depth = stages.queue.allocate(96 * 80 * sizeof(uint16_t));
    const std::array<const TestStack *, 3> in_turn{&blank, &stack, &blank};
    for (const TestStack *each : in_turn) {
        stages.buffer.assign(each->view());
        stages.luma.run(stages.buffer);
        stages.focus.run(stages.luma, false, false);
        grid.run(stages.focus.places(), stages.focus.mean());
        slice.run(grid, stages.focus.mean(), coder, depth);
        for (const uint16_t pixel : read_back<uint16_t>(stages.queue, depth, 96 * 80))
            ASSERT_EQ(pixel == 0, each == &blank);
    }
}
