/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/gaussian_blur.h"
#include "engine/sparse_depth.h"
#include "twin_focus.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace dff;

namespace {

struct Stages {
    explicit Stages(const TestStack &stack, float entropy_bits = 0.5f)
        : queue(Device::open("")), buffer(queue, stack.shape), luma(queue, stack.shape),
          focus(queue, stack.shape, 3), entropy(queue, stack.shape, entropy_bits),
          sparse(queue, stack.shape, 1.4f)
    {
        buffer.assign(stack.view());
        luma.run(buffer);
        focus.run(luma);
        entropy.run(luma);
    }

    CommandQueue queue;
    StackBuffer buffer;
    Luma luma;
    FocusMeasure focus;
    ZEntropy entropy;
    SparseDepth sparse;
};

size_t differences(const std::vector<uint8_t> &a, const std::vector<uint8_t> &b)
{
    size_t count = 0;
    for (size_t i = 0; i < a.size(); i++)
        count += a[i] != b[i];
    return count;
}

} // namespace

TEST(SparseDepth, agrees_with_its_twin)
{
    const TestStack stack({PixelFormat::Gray8, 131, 97, 8});
    Stages stages(stack);
    const size_t pixels = 131 * 97;
    const twin::Focus focus = twin::focus_product(twin::luma(stack), 3);

    stages.sparse.run(stages.focus, nullptr);
    const auto kept = twin::sparse_depth(focus, nullptr, 1.4f);
    EXPECT_LE(differences(read_back<uint8_t>(stages.queue, stages.sparse.places(), pixels), kept),
              pixels / 1000);
    const auto unknown = std::count(kept.begin(), kept.end(), 255);
    EXPECT_GT(unknown, 0);
    EXPECT_LT(unknown, static_cast<long>(pixels));

    stages.sparse.run(stages.focus, &stages.entropy);
    const auto moved = twin::z_entropy(twin::luma(stack), 0.5f);
    const auto still = twin::sparse_depth(focus, &moved, 1.4f);
    EXPECT_LE(differences(read_back<uint8_t>(stages.queue, stages.sparse.places(), pixels), still),
              pixels / 1000);
    EXPECT_NE(kept, still);
}

TEST(SparseDepth, a_picture_without_any_texture_is_unknown)
{
    TestStack stack({PixelFormat::Gray8, 64, 64, 4});
    std::fill(stack.memory.begin(), stack.memory.end(), std::byte{90});
    Stages stages(stack);
    stages.sparse.run(stages.focus, nullptr);
    for (const uint8_t plane : read_back<uint8_t>(stages.queue, stages.sparse.places(), 64 * 64))
        ASSERT_EQ(plane, SparseDepth::unknown_plane);
}

TEST(SparseDepth, confidence_is_full_where_one_plane_alone_is_sharp_and_none_where_all_are_alike)
{
    TestStack one_sharp({PixelFormat::Gray8, 64, 64, 4});
    for (unsigned z = 0; z < 4; z++) {
        const RowLayout &rows = one_sharp.layout[z];
        if (z != 2)
            std::fill_n(one_sharp.memory.begin() + rows.offset, 64 * 64, std::byte{128});
    }
    TestStack alike = one_sharp;
    for (unsigned z = 0; z < 4; z++)
        std::copy_n(one_sharp.memory.begin() + one_sharp.layout[2].offset, 64 * 64,
                    alike.memory.begin() + alike.layout[z].offset);

    for (const auto &[stack, expected] : {std::pair(&one_sharp, 255), std::pair(&alike, 0)}) {
        Stages stages(*stack);
        stages.sparse.run_confidence(stages.focus);
        const auto confidence = read_back<uint8_t>(stages.queue, stages.sparse.confidence(), 64 * 64);
        /* The gradient is 0 in the corners of the mirrored coarse pictures. */
        EXPECT_GE(std::count(confidence.begin(), confidence.end(), expected), 64 * 64 - 4 * 9);
    }
}

TEST(ZEntropy, agrees_with_its_twin)
{
    for (const float threshold : {0.5f, 1.0f, 2.0f}) {
        const TestStack stack({PixelFormat::Bgr, 97, 66, 64}, 7);
        Stages stages(stack, threshold);
        const auto found = read_back<uint8_t>(stages.queue, stages.entropy.moved(), 97 * 66);
        EXPECT_LE(differences(found, twin::z_entropy(twin::luma(stack), threshold)), 97 * 66 / 1000u);
    }
}

TEST(GaussianBlur, agrees_with_its_twin)
{
    const std::vector<float> taps = GaussianBlur::taps_for(16);
    ASSERT_EQ(taps.size(), 19u);
    CommandQueue queue(Device::open(""));
    Volume picture(70, 65, 1);
    for (size_t i = 0; i < picture.values.size(); i++)
        picture.values[i] = static_cast<float>(i * 7919 % 97);
    const size_t bytes = picture.values.size() * sizeof(float);
    const cl::Buffer buffer = queue.allocate(bytes);
    queue.commands().enqueueWriteBuffer(buffer, CL_TRUE, 0, bytes, picture.values.data());
    GaussianBlur blur(queue, 70, 65, taps);
    blur.run(buffer);

    const Volume expected = twin::gaussian_blur(picture, taps);
    const auto found = read_back<float>(queue, buffer, picture.values.size());
    for (size_t i = 0; i < found.size(); i++)
        ASSERT_NEAR(found[i], expected.values[i], 1e-3f);
}
