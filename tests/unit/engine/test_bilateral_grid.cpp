/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/bilateral_grid.h"
#include "engine/engine_error.h"
#include "twin_bilateral_grid.h"
#include "twin_focus.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

using namespace dff;

namespace {

/* Everything before the grid, run on the device. */
struct Stages {
    Stages(const TestStack &stack, const BilateralGrid::Parameters &parameters)
        : queue(Device::open("")), buffer(queue, stack.shape), luma(queue, stack.shape),
          focus(queue, stack.shape, 3), sparse(queue, stack.shape, 1.4f),
          reference(queue, stack.shape, parameters.sigma_chroma != 0), grid(queue, stack.shape, parameters)
    {
        buffer.assign(stack.view());
        luma.run(buffer);
        focus.run(luma);
        sparse.run(focus, nullptr);
        reference.run(buffer, luma);
        grid.run(sparse, reference);
    }

    CommandQueue queue;
    StackBuffer buffer;
    Luma luma;
    FocusMeasure focus;
    SparseDepth sparse;
    ReferenceImage reference;
    BilateralGrid grid;
};

} // namespace

class BilateralGridParameters : public testing::TestWithParam<BilateralGrid::Parameters> {};

TEST_P(BilateralGridParameters, agrees_with_its_twin)
{
    const TestStack stack({PixelFormat::Bgr, 150, 101, 6});
    Stages stages(stack, GetParam());
    const size_t pixels = 150 * 101;
    const bool chroma = GetParam().sigma_chroma != 0;
    const auto chroma_of = [&](const cl::Buffer &buffer) {
        return chroma ? read_back<uint8_t>(stages.queue, buffer, pixels) : std::vector<uint8_t>();
    };
    const Volume expected = twin::bilateral_solve(
        read_back<uint8_t>(stages.queue, stages.sparse.places(), pixels),
        read_back<uint8_t>(stages.queue, stages.reference.y(), pixels), chroma_of(stages.reference.u()),
        chroma_of(stages.reference.v()), 150, 101, GetParam());
    const auto found = read_back<float>(stages.queue, stages.grid.u(), pixels);
    for (size_t i = 0; i < pixels; i++)
        ASSERT_NEAR(found[i], expected.values[i], 0.005f) << "pixel " << i;
}

INSTANTIATE_TEST_SUITE_P(BilateralGrid, BilateralGridParameters,
                         testing::Values(BilateralGrid::Parameters{},
                                         BilateralGrid::Parameters{8, 32, 0, 0.1f, 25},
                                         BilateralGrid::Parameters{16, 16, 16, 0.1f, 25},
                                         BilateralGrid::Parameters{16, 16, 0, 2.0f, 60},
                                         BilateralGrid::Parameters{16, 16, 0, 0.1f, 0}));

TEST(BilateralGrid, nothing_known_is_not_a_number)
{
    TestStack stack({PixelFormat::Gray8, 64, 64, 4});
    std::fill(stack.memory.begin(), stack.memory.end(), std::byte{90});
    Stages stages(stack, {});
    for (const float u : read_back<float>(stages.queue, stages.grid.u(), 64 * 64))
        ASSERT_TRUE(std::isnan(u));
}

TEST(BilateralGrid, the_same_engine_works_again_after_nothing_was_known)
{
    TestStack blank({PixelFormat::Gray8, 64, 64, 4});
    std::fill(blank.memory.begin(), blank.memory.end(), std::byte{90});
    const TestStack stack({PixelFormat::Gray8, 64, 64, 4});
    Stages stages(blank, {});
    stages.buffer.assign(stack.view());
    stages.luma.run(stages.buffer);
    stages.focus.run(stages.luma);
    stages.sparse.run(stages.focus, nullptr);
    stages.reference.run(stages.buffer, stages.luma);
    stages.grid.run(stages.sparse, stages.reference);
    for (const float u : read_back<float>(stages.queue, stages.grid.u(), 64 * 64))
        ASSERT_FALSE(std::isnan(u));
}

TEST(BilateralGrid, too_fine_a_grid_is_refused)
{
    CommandQueue queue(Device::open(""));
    EXPECT_THROW(BilateralGrid(queue, {PixelFormat::Gray8, 8192, 8192, 2}, {4, 1, 1, 0.1f, 25}), EngineError);
}
