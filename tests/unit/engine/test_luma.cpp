/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/luma.h"
#include "engine/reference_image.h"
#include "twin_focus.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace dff;

namespace {

struct Stages {
    explicit Stages(const TestStack &stack)
        : queue(Device::open("")), buffer(queue, stack.shape), luma(queue, stack.shape),
          reference(queue, stack.shape, true)
    {
        buffer.assign(stack.view());
        luma.run(buffer);
        reference.run(buffer, luma);
    }

    CommandQueue queue;
    StackBuffer buffer;
    Luma luma;
    ReferenceImage reference;
};

} // namespace

class EveryFormat : public testing::TestWithParam<PixelFormat> {};

TEST_P(EveryFormat, reference_agrees_with_its_twin)
{
    const TestStack stack({GetParam(), 71, 67, 5});
    Stages stages(stack);

    const std::vector<uint8_t> expected = twin::mean_luma(twin::luma(stack));
    const auto found = read_back<uint8_t>(stages.queue, stages.reference.y(), expected.size());
    for (size_t i = 0; i < found.size(); i++)
        ASSERT_NEAR(found[i], expected[i], 1) << "pixel " << i;
}

TEST_P(EveryFormat, chroma_of_gray_is_neutral_and_of_colours_is_not)
{
    const TestStack stack({GetParam(), 64, 64, 3});
    Stages stages(stack);

    const bool gray = GetParam() == PixelFormat::Gray8 || GetParam() == PixelFormat::Gray16;
    for (const cl::Buffer *chroma : {&stages.reference.u(), &stages.reference.v()}) {
        const auto values = read_back<uint8_t>(stages.queue, *chroma, 64 * 64);
        const bool neutral = std::all_of(values.begin(), values.end(), [](uint8_t c) { return c == 128; });
        EXPECT_EQ(neutral, gray);
    }
}

INSTANTIATE_TEST_SUITE_P(Luma, EveryFormat,
                         testing::Values(PixelFormat::Gray8, PixelFormat::Gray16, PixelFormat::I420,
                                         PixelFormat::Nv12, PixelFormat::Rgb, PixelFormat::Bgr,
                                         PixelFormat::Rgbx, PixelFormat::Bgrx, PixelFormat::Rgba64));

TEST(ReferenceImage, chroma_of_i420_and_nv12_is_the_mean_of_their_samples)
{
    for (const PixelFormat format : {PixelFormat::I420, PixelFormat::Nv12}) {
        const TestStack stack({format, 65, 67, 3});
        Stages stages(stack);
        const auto u = read_back<uint8_t>(stages.queue, stages.reference.u(), 65 * 67);
        const auto v = read_back<uint8_t>(stages.queue, stages.reference.v(), 65 * 67);
        for (unsigned y = 0; y < 67; y++)
            for (unsigned x = 0; x < 65; x++) {
                unsigned sum_u = 0, sum_v = 0;
                for (unsigned z = 0; z < 3; z++) {
                    const bool planar = format == PixelFormat::I420;
                    sum_u += stack.sample(1, planar ? x / 2 : x / 2 * 2, y / 2, z);
                    sum_v += stack.sample(planar ? 2 : 1, planar ? x / 2 : x / 2 * 2 + 1, y / 2, z);
                }
                ASSERT_EQ(u[y * 65 + x], sum_u / 3);
                ASSERT_EQ(v[y * 65 + x], sum_v / 3);
            }
    }
}
