/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/focus_engine.h"
#include "engine/gaussian_blur.h"
#include "engine/self_test.h"
#include "twin_bilateral_grid.h"
#include "twin_focus.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace dff;

namespace {

struct Maps {
    explicit Maps(const StackShape &shape)
        : depth(shape.width * shape.height), sparse(depth.size()), confidence(depth.size()),
          motion(depth.size()), outputs{picture(depth, shape),
                                        picture(sparse, shape),
                                        picture(confidence, shape),
                                        picture(motion, shape),
                                        {}}
    {
    }

    template <typename T> static OutputPicture picture(std::vector<T> &values, const StackShape &shape)
    {
        return {std::as_writable_bytes(std::span(values)).data(), shape.width * sizeof(T)};
    }

    std::vector<uint16_t> depth, sparse;
    std::vector<uint8_t> confidence, motion;
    DepthOutputs outputs;
};

DepthParameters with(Method method)
{
    DepthParameters parameters;
    parameters.method = method;
    return parameters;
}

class BothMethods : public testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(FocusEngine, BothMethods, testing::Values(Method::Volume, Method::Paper));

} // namespace

/* The whole method against the twins one after the other; test_cpu_kernels holds the CPU's kernels to them.
 */
class FocusEngineFormats : public testing::TestWithParam<PixelFormat> {};

TEST_P(FocusEngineFormats, agree_with_the_twins)
{
    const TestStack stack({GetParam(), 161, 131, 10});
    FocusEngine engine(device_with(KernelStyle::Pixels), stack.shape, with(Method::Paper));
    Maps maps(stack.shape);
    ASSERT_TRUE(engine.compute(stack.view(), maps.outputs));

    const Volume luma = twin::luma(stack);
    const auto moved = twin::z_entropy(luma, 2.0f);
    const auto sparse = twin::sparse_depth(twin::focus_product(luma, 3), &moved, 1.4f);
    const Volume filled = twin::bilateral_solve(sparse, twin::mean_luma(luma), {}, {}, 161, 131, {});
    const Volume u = twin::gaussian_blur(filled, GaussianBlur::taps_for(16));
    const DepthEncoder encoder = DepthEncoder::index(10);

    size_t far_off = 0, other_sparse = 0;
    for (size_t i = 0; i < maps.depth.size(); i++) {
        const double error = encoder.decode(maps.depth[i]).value() - u.values[i];
        far_off += std::abs(error) > 9.0 / 255.0;
        const uint16_t expected = sparse[i] == 255 ? 0 : encoder.encode(0.5 * sparse[i]);
        other_sparse += maps.sparse[i] != expected;
        ASSERT_EQ(maps.motion[i], moved[i]);
    }
    EXPECT_LE(far_off, maps.depth.size() / 100) << "within 1/255 of the range on 99 % of the pixels";
    EXPECT_LE(other_sparse, maps.depth.size() / 1000);
}

INSTANTIATE_TEST_SUITE_P(FocusEngine, FocusEngineFormats,
                         testing::Values(PixelFormat::Bgr, PixelFormat::Rgba64));

/* Kernels for CPUs and for GPUs are two ways to one depth; sizes that no level of the focus measure divides.
 */
TEST(FocusEngine, both_styles_make_the_same_depth_of_a_stack)
{
    for (const StackShape &shape : {self_test::shape, StackShape{PixelFormat::I420, 398, 322, 6},
                                    StackShape{PixelFormat::I420, 194, 482, 9}}) {
        TestStack stack(shape);
        stack.memory = self_test::stack(shape);
        Maps pixels(shape), tiles(shape);
        FocusEngine(device_with(KernelStyle::Pixels), shape, with(Method::Paper))
            .compute(stack.view(), pixels.outputs);
        FocusEngine(device_with(KernelStyle::Tiles), shape, with(Method::Paper))
            .compute(stack.view(), tiles.outputs);
        size_t by_a_hundredth = 0;
        int most = 0;
        for (size_t i = 0; i < pixels.depth.size(); i++) {
            const int difference = std::abs(pixels.depth[i] - tiles.depth[i]);
            by_a_hundredth += difference > 655;
            most = std::max(most, difference);
        }
        EXPECT_LE(most, 1310) << "2 % of the range, " << shape.width;
        EXPECT_LE(by_a_hundredth, pixels.depth.size() / 1000) << shape.width;
    }
}

TEST_P(BothMethods, a_stack_without_texture_has_no_depth)
{
    TestStack stack({PixelFormat::I420, 64, 64, 4});
    std::fill(stack.memory.begin(), stack.memory.end(), std::byte{90});
    FocusEngine engine(Device::open(""), stack.shape, with(GetParam()));
    Maps maps(stack.shape);
    EXPECT_FALSE(engine.compute(stack.view(), maps.outputs));
    EXPECT_EQ(std::count(maps.depth.begin(), maps.depth.end(), 0), 64 * 64);
    EXPECT_EQ(std::count(maps.confidence.begin(), maps.confidence.end(), 0), 64 * 64);
}

TEST_P(BothMethods, the_encoder_gives_the_unit)
{
    const TestStack stack({PixelFormat::Gray8, 96, 80, 6});
    FocusEngine engine(Device::open(""), stack.shape, with(GetParam()));
    Maps index(stack.shape), millimetre(stack.shape);
    engine.compute(stack.view(), index.outputs);
    const DepthEncoder encoder = DepthEncoder::millimetre(SweepPlan::even(6, 5.0, 1.0));
    engine.set_encoder(encoder);
    engine.compute(stack.view(), millimetre.outputs);
    for (size_t i = 0; i < index.depth.size(); i++)
        ASSERT_EQ(millimetre.depth[i], encoder.encode(DepthEncoder::index(6).decode(index.depth[i]).value()));
}

TEST(FocusEngine, more_iterations_leave_less_residual)
{
    const TestStack stack({PixelFormat::Gray8, 160, 128, 4});
    std::vector<float> residuals;
    for (const unsigned iterations : {2u, 25u}) {
        DepthParameters parameters;
        parameters.method = Method::Paper;
        parameters.grid.iterations = iterations;
        FocusEngine engine(device_with(KernelStyle::Tiles), stack.shape, parameters);
        Maps maps(stack.shape);
        engine.compute(stack.view(), maps.outputs);
        residuals.push_back(engine.residual().value());
    }
    EXPECT_LT(residuals[0], 1.0f);
    EXPECT_GT(residuals[0], 4.0f * residuals[1]);
    EXPECT_GE(residuals[1], 0.0f);
}

TEST(FocusEngine, every_stage_has_a_time)
{
    const TestStack stack({PixelFormat::Gray8, 64, 64, 3});
    const std::vector<std::string> of_pixels = {"luma",      "focus-measure", "z-entropy", "sparse-depth",
                                                "reference", "splat",         "solve",     "slice",
                                                "blur",      "code",          "confidence"};
    const std::vector<std::string> of_tiles = {"luma",  "focus-measure", "sparse-depth",
                                               "splat", "solve",         "slice"};
    for (const auto &[style, stages] :
         {std::pair(KernelStyle::Pixels, of_pixels), std::pair(KernelStyle::Tiles, of_tiles)}) {
        FocusEngine engine(device_with(style), stack.shape, with(Method::Paper));
        Maps maps(stack.shape);
        engine.compute(stack.view(), maps.outputs);
        for (const std::string &stage : stages)
            EXPECT_EQ(std::count_if(engine.times().begin(), engine.times().end(),
                                    [&](const auto &time) { return time.first == stage; }),
                      1)
                << stage;
    }
}
