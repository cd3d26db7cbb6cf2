/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/luma.h"
#include "engine/stack_denoiser.h"
#include "noisy_stack.h"
#include "twin_denoiser.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

using namespace dff;

namespace {

void denoise(StackDenoiser &denoiser, TestStack &stack, const DenoiseParameters &parameters = {},
             uint64_t absent = 0)
{
    const StackView view = stack.view();
    denoiser.denoise(view, stack.memory, absent, parameters);
}

struct Case {
    PixelFormat format;
    KernelStyle style;
};

class Formats : public testing::TestWithParam<Case> {};

std::string name_of(const testing::TestParamInfo<Case> &info)
{
    static const char *const names[] = {"gray8", "gray16", "i420", "nv12",  "rgb",
                                        "bgr",   "rgbx",   "bgrx", "rgba64"};
    return std::string(names[static_cast<int>(info.param.format)]) +
           (info.param.style == KernelStyle::Tiles ? "_tiles" : "_pixels");
}

/* With the noise that the report tells. Something moves in the third stack. */
void expect_agreement(const StackShape &shape, KernelStyle style)
{
    const TestStack clean = smooth_stack(shape);
    StackDenoiser denoiser(device_with(style), shape);
    twin::Denoiser twin(shape);
    for (unsigned t = 0; t < 5; t++) {
        TestStack stack = noisy(clean, 4.0, t);
        if (t >= 2)
            for (unsigned y = 20; y < shape.height; y += 97)
                std::fill_n(stack.memory.begin() + static_cast<std::ptrdiff_t>(stack.layout[1].offset +
                                                                               y * stack.layout[1].stride),
                            stack.layout[1].stride / 2, std::byte{200});
        TestStack expected = stack;
        denoise(denoiser, stack, {3, 1.0F});
        const DenoiseReport used = denoiser.report();
        twin.denoise(expected, used.noise[0], used.spread[0], 3);
        EXPECT_LT(mean_square(stack, expected), 0.002) << "stack " << t;
    }
}

} // namespace

/* The picture's sizes are no multiples of a tile's. */
TEST(StackDenoiser, agrees_with_its_twin)
{
    for (const PixelFormat format : {PixelFormat::Gray8, PixelFormat::Gray16, PixelFormat::Rgb})
        for (const KernelStyle style : {KernelStyle::Tiles, KernelStyle::Pixels})
            expect_agreement({format, 75, 67, 2}, style);
}

/* CPUs denoise strips of 184 rows apart from each other, in place. */
TEST(StackDenoiser, strips_meet_without_a_seam)
{
    expect_agreement({PixelFormat::Gray8, 75, 601, 2}, KernelStyle::Tiles);
    expect_agreement({PixelFormat::Rgbx, 64, 290, 2}, KernelStyle::Tiles);
}

TEST_P(Formats, noise_of_a_still_scene_falls_with_the_number_of_sweeps)
{
    const StackShape shape{GetParam().format, 130, 94, 3};
    const TestStack clean = smooth_stack(shape);
    StackDenoiser denoiser(device_with(GetParam().style), shape);
    double error = 0.0;
    for (unsigned t = 0; t < 8; t++) {
        TestStack stack = noisy(clean, 6.0, t);
        denoise(denoiser, stack);
        error = mean_square(stack, clean);
    }
    EXPECT_LT(error, 36.0 / 8 * 1.15 + 1.0 / 12);
    EXPECT_GT(denoiser.report().mean_sweeps, 7.5);
}

TEST_P(Formats, noise_is_told)
{
    const StackShape shape{GetParam().format, 320, 240, 2};
    const TestStack clean = smooth_stack(shape);
    StackDenoiser denoiser(device_with(GetParam().style), shape);
    for (unsigned t = 0; t < 4; t++) {
        TestStack stack = noisy(clean, 6.0, t);
        denoise(denoiser, stack);
    }
    const DenoiseReport report = denoiser.report();
    for (const NoiseCurve &curve : report.noise)
        EXPECT_NEAR(std::sqrt(curve[8]) * report.sample_unit, 6.0, 0.9);
}

/* The mean over more sweeps than `frames` has less than 1 / frames of their variance. */
TEST_P(Formats, what_noise_is_left_is_told)
{
    const StackShape shape{GetParam().format, 320, 240, 2};
    const TestStack clean = smooth_stack(shape);
    StackDenoiser denoiser(device_with(GetParam().style), shape);
    for (unsigned t = 0; t < 14; t++) {
        TestStack stack = noisy(clean, 6.0, t);
        denoise(denoiser, stack, {4, 1.0F});
        const auto told = denoiser.report().left;
        ASSERT_EQ(told.has_value(), t > 0);
        if (!told)
            continue;
        const bool is_mixed = is_interleaved(shape.format); /* luma of three samples that are noisy apart */
        const double is = std::sqrt(mean_square(stack, clean)) * (is_mixed ? 0.669 : 1.0);
        EXPECT_NEAR(*told / is, 1.0, 0.15) << "stack " << t;
    }
}

TEST_P(Formats, a_cut_shows_the_new_scene_alone)
{
    const StackShape shape{GetParam().format, 96, 80, 2};
    const TestStack before = smooth_stack(shape), after = smooth_stack(shape, 2.5);
    StackDenoiser denoiser(device_with(GetParam().style), shape);
    for (unsigned t = 0; t < 4; t++) {
        TestStack stack = noisy(before, 3.0, t);
        denoise(denoiser, stack);
    }
    const TestStack cut = noisy(after, 3.0, 9);
    TestStack stack = cut;
    denoise(denoiser, stack);
    EXPECT_EQ(stack.memory, cut.memory);
}

/* Later on, noise is looked at less often. */
TEST(StackDenoiser, noise_that_changes_late_is_told)
{
    const StackShape shape{PixelFormat::Gray8, 320, 240, 2};
    const TestStack clean = smooth_stack(shape);
    StackDenoiser denoiser(Device::open(""), shape);
    for (unsigned t = 0; t < 64; t++) {
        TestStack stack = noisy(clean, t < 40 ? 3.0 : 6.0, t);
        denoise(denoiser, stack);
    }
    const DenoiseReport report = denoiser.report();
    EXPECT_NEAR(std::sqrt(report.noise.front()[8]), 6.0, 0.9);
    EXPECT_GT(report.mean_sweeps, 7.0);
}

/* What all of the picture does from the first sweep on is not learned as noise. */
TEST_P(Formats, a_camera_that_pans_leaves_no_ghost)
{
    const StackShape shape{GetParam().format, 320, 240, 2};
    StackDenoiser denoiser(device_with(GetParam().style), shape);
    for (unsigned t = 0; t < 4; t++) {
        const TestStack input = noisy(smooth_stack(shape, 0.4 * t), 6.0, t);
        TestStack stack = input;
        denoise(denoiser, stack);
        EXPECT_LT(mean_square(stack, input), 0.02 * 36.0) << "stack " << t;
    }
}

/* The camera moves by pixels that are told. */
TEST_P(Formats, what_is_shifted_is_averaged_with_the_same_places)
{
    const StackShape shape{GetParam().format, 198, 150, 3};
    const auto scene = [&](int x0, int y0) {
        TestStack stack(shape);
        for_each_sample(shape, [&](size_t c, const Component &of, unsigned z, unsigned x, unsigned y) {
            const double px = (x / of.channels + 0.5) * of.subsampling + x0,
                         py = (y + 0.5) * of.subsampling + y0;
            const double value = 128 + 50 * std::sin(0.31 * px + 0.17 * py + z);
            set_sample(stack, of, stack.layout[c * shape.planes + z], x, y,
                       of.sample_bytes == 2 ? 256 * value : value);
        });
        return stack;
    };
    /* Without what came in since: 8 sweeps, and the tiles beside it. */
    const auto inner_error = [&](const TestStack &a, const TestStack &b) {
        double sum = 0.0, count = 0.0;
        for_each_sample(shape, [&](size_t c, const Component &of, unsigned z, unsigned x, unsigned y) {
            const unsigned px = x / of.channels * of.subsampling, py = y * of.subsampling;
            if (px < 72 || px >= shape.width - 72 || py < 56 || py >= shape.height - 56)
                return;
            const RowLayout &rows = a.layout[c * shape.planes + z];
            const double difference =
                static_cast<double>(sample_of(a, of, rows, x, y)) - sample_of(b, of, rows, x, y);
            sum += difference * difference / (of.sample_bytes == 2 ? 65536.0 : 1.0);
            count++;
        });
        return sum / count;
    };
    for (const auto &[right, down] : {std::pair(6, -4), {-2, 2}, {8, 0}}) {
        StackDenoiser denoiser(device_with(GetParam().style), shape);
        double error = 0.0, told = 0.0;
        for (int t = 0; t < 8; t++) {
            const TestStack clean = scene(right * t, down * t);
            TestStack stack = noisy(clean, 6.0, static_cast<unsigned>(t));
            denoiser.shift(right, down);
            denoise(denoiser, stack);
            error = inner_error(stack, clean);
            told = denoiser.report().mean_sweeps;
        }
        EXPECT_LT(error, 36.0 / 8 * 1.2 + 1.0 / 12) << right << ", " << down;
        EXPECT_GT(told, 5.0);
    }
}

TEST(StackDenoiser, what_is_shifted_out_of_the_picture_is_forgotten)
{
    const StackShape shape{PixelFormat::Gray8, 96, 80, 2};
    const TestStack clean = smooth_stack(shape);
    for (const auto &[right, down] : {std::pair(96, 0), {0, -80}, {-2000, 4000}}) {
        StackDenoiser denoiser(Device::open(""), shape);
        TestStack first = noisy(clean, 3.0, 1);
        denoise(denoiser, first);
        denoiser.shift(right, down);
        const TestStack input = noisy(clean, 3.0, 2);
        TestStack second = input;
        denoise(denoiser, second);
        EXPECT_EQ(second.memory, input.memory);
    }
}

INSTANTIATE_TEST_SUITE_P(StackDenoiser, Formats,
                         testing::Values(Case{PixelFormat::Gray8, KernelStyle::Tiles},
                                         Case{PixelFormat::Gray8, KernelStyle::Pixels},
                                         Case{PixelFormat::Gray16, KernelStyle::Tiles},
                                         Case{PixelFormat::I420, KernelStyle::Tiles},
                                         Case{PixelFormat::I420, KernelStyle::Pixels},
                                         Case{PixelFormat::Nv12, KernelStyle::Tiles},
                                         Case{PixelFormat::Rgb, KernelStyle::Tiles},
                                         Case{PixelFormat::Bgrx, KernelStyle::Tiles},
                                         Case{PixelFormat::Rgba64, KernelStyle::Tiles},
                                         Case{PixelFormat::Rgba64, KernelStyle::Pixels}),
                         name_of);

/* Even where texture moves by a pixel only, which hardly changes a tile's mean. */
TEST(StackDenoiser, what_moves_leaves_no_ghost)
{
    const StackShape shape{PixelFormat::Gray8, 160, 96, 2};
    TestStack texture = smooth_stack(shape);
    const TestStack fine(shape);
    for (unsigned z = 0; z < shape.planes; z++)
        for (unsigned y = 24; y < 72; y++)
            for (unsigned x = 32; x < 128; x++)
                set_sample(texture, shape.components()[0], texture.layout[z], x, y, fine.sample(0, x, y, z));
    StackDenoiser denoiser(Device::open(""), shape);
    for (unsigned t = 0; t < 6; t++) {
        TestStack moving = texture;
        for (unsigned z = 0; z < shape.planes; z++)
            for (unsigned y = 32; y < 64; y++)
                for (unsigned x = 40; x < 100; x++)
                    set_sample(moving, shape.components()[0], moving.layout[z], x, y,
                               texture.sample(0, x + t, y, z));
        moving = noisy(moving, 3.0, t);
        TestStack stack = moving;
        denoise(denoiser, stack);
        for (unsigned z = 0; z < shape.planes; z++)
            for (unsigned y = 32; y < 64; y++)
                for (unsigned x = 40; x < 100; x++)
                    ASSERT_EQ(stack.sample(0, x, y, z), moving.sample(0, x, y, z))
                        << x << " " << y << " in " << t;
    }
}

TEST(StackDenoiser, a_plane_that_is_absent_stays_as_it_is_and_the_next_goes_on)
{
    const StackShape shape{PixelFormat::I420, 96, 80, 3};
    const TestStack clean = smooth_stack(shape);
    StackDenoiser denoiser(Device::open(""), shape);
    for (const unsigned t : {0U, 1U, 2U}) {
        const TestStack input = noisy(t == 1 ? smooth_stack(shape, 1.0) : clean, 3.0, t);
        TestStack stack = input;
        denoise(denoiser, stack, {}, t == 1 ? 7 : 0);
        if (t < 2)
            EXPECT_EQ(stack.memory, input.memory);
        else
            EXPECT_LT(mean_square(stack, clean), 9.0 / 2 * 1.2);
    }
}

/* Each plane of a rolling window comes in as many stacks as a sweep has planes; it counts once. */
TEST(StackDenoiser, a_plane_that_comes_again_counts_once)
{
    const StackShape shape{PixelFormat::Gray8, 96, 80, 2};
    const TestStack clean = smooth_stack(shape);
    StackDenoiser denoiser(Device::open(""), shape);
    TestStack first = noisy(clean, 3.0, 1), second = noisy(clean, 3.0, 2);
    std::copy_n(first.memory.begin(), first.layout[1].offset, second.memory.begin()); /* plane 0 again */
    const auto once = [&](TestStack stack, uint64_t sweep_of_plane_1) {
        StackView view = stack.view();
        view.identities = {PlaneIdentity{0, 0}, PlaneIdentity{sweep_of_plane_1, 1}};
        denoiser.denoise(view, stack.memory, 0, {});
        return stack;
    };
    once(first, 0);
    const TestStack after = once(second, 1);
    EXPECT_TRUE(std::equal(first.memory.begin(), first.memory.begin() + first.layout[1].offset,
                           after.memory.begin()));
    EXPECT_NEAR(denoiser.report().mean_sweeps, 1.5, 0.01);
}

TEST(StackDenoiser, what_is_forgotten_is_averaged_with_nothing)
{
    const StackShape shape{PixelFormat::Gray16, 96, 80, 2};
    const TestStack clean = smooth_stack(shape);
    StackDenoiser denoiser(Device::open(""), shape);
    TestStack first = noisy(clean, 3.0, 1);
    denoise(denoiser, first);
    denoiser.forget();
    const TestStack input = noisy(clean, 3.0, 2);
    TestStack second = input;
    denoise(denoiser, second);
    EXPECT_EQ(second.memory, input.memory);
}

/* Rows of the stack may be padded, and what lies between them is not touched. */
TEST(StackDenoiser, bytes_between_the_rows_stay)
{
    const StackShape shape{PixelFormat::Gray8, 70, 66, 2};
    std::vector<std::byte> memory(100 + 96 * 66 * 2, std::byte{77});
    const StackView view{shape, memory, {{100, 96}, {100 + 96 * 66, 96}}};
    StackDenoiser denoiser(Device::open(""), shape);
    for (unsigned t = 0; t < 3; t++) {
        for (unsigned y = 0; y < 132; y++)
            std::fill_n(memory.begin() + 100 + 96 * y, 70, static_cast<std::byte>(100 + t));
        denoiser.denoise(view, memory, 0, {});
    }
    for (size_t i = 0; i < memory.size(); i++) {
        const bool is_between = i < 100 || (i - 100) % 96 >= 70;
        EXPECT_TRUE(!is_between || memory[i] == std::byte{77}) << i;
    }
}
