/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/engine_error.h"
#include "engine/focus_engine.h"
#include "engine/noise_estimate.h"
#include "test_stack.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

using namespace dff;

namespace {

/* A board of squares in 8 bits, `blur` planes' worth of contrast lost a plane away from where it is sharp.
 * The left half is sharp in `left`, the right in `right`. */
TestStack two_halves(const StackShape &shape, float left, float right, float noise = 0.0f)
{
    TestStack stack(shape);
    std::mt19937 random(7);
    std::normal_distribution<float> grain(0.0f, 1.0f);
    const std::vector<Component> components = shape.components();
    for (size_t c = 0; c < components.size(); c++)
        for (unsigned z = 0; z < shape.planes; z++)
            for (unsigned y = 0; y < components[c].height; y++)
                for (unsigned x = 0; x < components[c].width; x++) {
                    const unsigned pixel_x = x / components[c].channels * components[c].subsampling;
                    const float sharp_at = pixel_x < shape.width / 2 ? left : right;
                    const float contrast = 60.0f / (1.0f + std::abs(static_cast<float>(z) - sharp_at));
                    const float wave =
                        std::sin(0.9f * static_cast<float>(pixel_x)) + std::sin(0.8f * static_cast<float>(y));
                    const float value = 128.0f + contrast * wave + noise * grain(random);
                    const RowLayout &rows = stack.layout[c * shape.planes + z];
                    for (unsigned byte = 0; byte < components[c].sample_bytes; byte++)
                        stack.memory[rows.offset + rows.stride * y + x * components[c].sample_bytes + byte] =
                            static_cast<std::byte>(std::clamp(value, 0.0f, 255.0f));
                }
    return stack;
}

/* How a bar code behind the far end of the sweep was taken: no plane has it sharp, the last one least
 * blurred. */
struct Stripes {
    float narrowest, widest; /* pixels */
    float blur, blur_step;   /* sigma in the last plane, and what each plane before it adds; pixels */
    float shot_noise;        /* noise a DN of brightness, times 4 */
};

TestStack blurred_stripes(const StackShape &shape, const Stripes &stripes)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<float> stripe_width(stripes.narrowest, stripes.widest);
    std::normal_distribution<float> grain(0.0f, 0.25f);
    std::vector<float> edges;
    for (float x = 0.0f; x < static_cast<float>(shape.width); x += stripe_width(random))
        edges.push_back(x);

    TestStack stack(shape);
    for (unsigned z = 0; z < shape.planes; z++) {
        const float sigma = stripes.blur + stripes.blur_step * static_cast<float>(shape.planes - 1 - z);
        for (unsigned x = 0; x < shape.width; x++) {
            float value = 60.0f;
            for (size_t i = 0; i < edges.size(); i++)
                value +=
                    (i % 2 ? -60.0f : 60.0f) * (1.0f + std::erf((static_cast<float>(x) - edges[i]) / sigma));
            for (unsigned y = 0; y < shape.height; y++)
                stack.memory[stack.layout[z].offset + stack.layout[z].stride * y + x] =
                    static_cast<std::byte>(std::clamp(
                        value + (1.0f + stripes.shot_noise * value) * grain(random), 0.0f, 255.0f));
        }
    }
    return stack;
}

struct Result {
    std::vector<double> u; /* -1 where there is no value */
    std::vector<uint16_t> depth, sparse;
    std::vector<uint8_t> confidence;
};

Result compute(const TestStack &stack, bool with_maps = false)
{
    const StackShape &shape = stack.shape;
    DepthParameters parameters;
    parameters.method = Method::Volume;
    FocusEngine engine(Device::open(""), shape, parameters);
    Result result;
    result.depth.resize(size_t{shape.width} * shape.height);
    result.sparse.resize(result.depth.size());
    result.confidence.resize(result.depth.size());
    DepthOutputs outputs;
    outputs.depth = {std::as_writable_bytes(std::span(result.depth)).data(), shape.width * sizeof(uint16_t)};
    if (with_maps) {
        outputs.sparse = {std::as_writable_bytes(std::span(result.sparse)).data(),
                          shape.width * sizeof(uint16_t)};
        outputs.confidence = {std::as_writable_bytes(std::span(result.confidence)).data(), shape.width};
    }
    engine.compute(stack.view(), outputs);
    const DepthEncoder encoder = DepthEncoder::index(shape.planes);
    for (const uint16_t pixel : result.depth)
        result.u.push_back(encoder.decode(pixel).value_or(-1.0));
    return result;
}

const RowLayout &rows_of(const TestStack &stack, size_t component, uint32_t z)
{
    return stack.layout[component * stack.shape.planes + z];
}

/* How much is told of a blank picture whose planes differ by nothing but noise of this deviation, 0..255. */
double confidence_in_noise(float sigma)
{
    TestStack stack({PixelFormat::Rgb, 320, 240, 6});
    std::mt19937 random(3);
    std::normal_distribution<float> grain(128.0f, sigma);
    for (std::byte &sample : stack.memory)
        sample = static_cast<std::byte>(std::clamp(std::rint(grain(random)), 0.0f, 255.0f));
    const std::vector<uint8_t> told = compute(stack, true).confidence;
    return std::accumulate(told.begin(), told.end(), 0.0) / static_cast<double>(told.size());
}

/* Mean error of the middle of each half, in planes. */
double error_of(const Result &result, const StackShape &shape, float left, float right)
{
    double sum = 0.0;
    unsigned count = 0;
    for (unsigned y = 8; y + 8 < shape.height; y++)
        for (unsigned x = 8; x + 8 < shape.width; x++) {
            if (x + 12 > shape.width / 2 && x < shape.width / 2 + 12)
                continue;
            const double u = result.u[size_t{y} * shape.width + x];
            sum += std::abs(u - (x < shape.width / 2 ? left : right));
            count++;
        }
    return sum / count;
}

} // namespace

class VolumeShapes : public testing::TestWithParam<StackShape> {};

TEST_P(VolumeShapes, two_surfaces_lie_in_their_planes)
{
    const StackShape shape = GetParam();
    const auto last = static_cast<float>(shape.planes - 1);
    const float left = std::round(0.2f * last), right = std::round(0.8f * last);
    const Result result = compute(two_halves(shape, left, right));
    EXPECT_LT(error_of(result, shape, left, right), 0.25 + 0.01 * last);
}

INSTANTIATE_TEST_SUITE_P(
    VolumeMethod, VolumeShapes,
    testing::Values(StackShape{PixelFormat::Gray8, 64, 64, 2}, StackShape{PixelFormat::Gray8, 99, 67, 3},
                    StackShape{PixelFormat::Gray8, 120, 90, 64}, StackShape{PixelFormat::Gray16, 131, 97, 6},
                    StackShape{PixelFormat::I420, 161, 121, 10}, StackShape{PixelFormat::Nv12, 160, 121, 6},
                    StackShape{PixelFormat::Rgb, 97, 131, 5}, StackShape{PixelFormat::Bgrx, 129, 80, 5},
                    StackShape{PixelFormat::Rgba64, 131, 97, 6}));

TEST(VolumeMethod, depth_is_finer_than_a_plane)
{
    const StackShape shape{PixelFormat::Gray8, 160, 120, 8};
    EXPECT_LT(error_of(compute(two_halves(shape, 2.5f, 4.5f)), shape, 2.5f, 4.5f), 0.2);
}

TEST(VolumeMethod, depth_is_not_drawn_to_the_planes)
{
    const StackShape shape{PixelFormat::Gray8, 160, 120, 8};
    EXPECT_LT(error_of(compute(two_halves(shape, 2.25f, 4.7f)), shape, 2.25f, 4.7f), 0.08);
}

TEST(VolumeMethod, noise_moves_surfaces_by_less_than_half_a_plane)
{
    const StackShape shape{PixelFormat::Gray8, 160, 120, 8};
    EXPECT_LT(error_of(compute(two_halves(shape, 2.0f, 5.0f, 8.0f)), shape, 2.0f, 5.0f), 0.5);
}

/* A blank middle between textured surroundings, all in one plane. */
TEST(VolumeMethod, what_has_no_texture_is_smooth_and_says_so)
{
    const StackShape shape{PixelFormat::Gray8, 192, 192, 6};
    TestStack stack = two_halves(shape, 3.0f, 3.0f);
    for (unsigned z = 0; z < shape.planes; z++)
        for (unsigned y = 64; y < 128; y++)
            for (unsigned x = 64; x < 128; x++)
                stack.memory[stack.layout[z].offset + stack.layout[z].stride * y + x] = std::byte{128};
    const Result result = compute(stack, true);
    double off = 0.0;
    for (unsigned y = 72; y < 120; y++)
        for (unsigned x = 72; x < 120; x++) {
            const size_t pixel = size_t{y} * shape.width + x;
            off = std::max(off, std::abs(result.u[pixel] - 3.0));
            ASSERT_LT(result.confidence[pixel], result.confidence[size_t{20} * shape.width + 20] / 2);
            ASSERT_EQ(result.sparse[pixel], 0);
        }
    EXPECT_LT(off, 0.5);
    EXPECT_EQ(result.sparse[size_t{20} * shape.width + 20], result.depth[size_t{20} * shape.width + 20]);
}

/* Where noise is weak least is blurred away before focus is measured, and most of it is left. */
TEST(VolumeMethod, weak_noise_tells_no_more_than_strong_noise)
{
    const double strong = confidence_in_noise(7.0f);
    EXPECT_LT(confidence_in_noise(0.8f), 1.2 * strong);
    EXPECT_LT(confidence_in_noise(1.2f), 1.2 * strong);
}

TEST(VolumeMethod, stripes_nowhere_in_focus_lie_where_they_are_least_blurred)
{
    const StackShape shape{PixelFormat::Gray8, 400, 160, 7};
    const Result result = compute(blurred_stripes(shape, {24.0f, 60.0f, 8.0f, 2.0f, 0.0f}));
    const auto near = std::count_if(result.u.begin(), result.u.end(), [](double u) { return u < 5.0; });
    EXPECT_LT(near, static_cast<std::ptrdiff_t>(result.u.size() / 10));
}

/* Their middle shows nothing but noise and what blur brings there in the near planes; bright parts are the
 * noisier. */
TEST(VolumeMethod, wide_stripes_lie_where_their_edges_are_least_blurred)
{
    const StackShape shape{PixelFormat::Gray8, 2000, 256, 7};
    const Result result = compute(blurred_stripes(shape, {80.0f, 120.0f, 6.0f, 4.0f, 0.01f}));
    const auto near = std::count_if(result.u.begin(), result.u.end(), [](double u) { return u < 5.0; });
    EXPECT_LT(near, static_cast<std::ptrdiff_t>(result.u.size() / 20));
}

/* Takes planes one by one from each of two stacks in turn, as a rolling window does; then three at once. */
TEST(VolumeMethod, a_rolling_window_has_the_depth_of_whole_stacks)
{
    const StackShape shape{PixelFormat::I420, 160, 121, 6};
    const TestStack sweeps[2] = {two_halves(shape, 1.0f, 4.0f), two_halves(shape, 3.0f, 2.0f, 6.0f)};
    TestStack window = sweeps[0];
    StackView view = window.view();
    for (uint32_t z = 0; z < shape.planes; z++)
        view.identities.push_back(PlaneIdentity{0, z});
    const auto take = [&](uint64_t sweep, uint32_t z) {
        for (size_t c = 0; c < shape.components().size(); c++) {
            const RowLayout &rows = rows_of(window, c, z);
            std::copy_n(sweeps[sweep % 2].memory.begin() + static_cast<std::ptrdiff_t>(rows.offset),
                        rows.stride * shape.components()[c].height,
                        window.memory.begin() + static_cast<std::ptrdiff_t>(rows.offset));
        }
        view.identities[z] = PlaneIdentity{sweep, z};
    };
    DepthParameters parameters;
    parameters.method = Method::Volume;
    FocusEngine rolling(Device::open(""), shape, parameters);
    std::vector<uint16_t> depth(size_t{shape.width} * shape.height);
    DepthOutputs outputs;
    outputs.depth = {std::as_writable_bytes(std::span(depth)).data(), shape.width * sizeof(uint16_t)};

    for (const auto &planes : std::vector<std::vector<uint32_t>>{{}, {0}, {1}, {2}, {3, 4, 5}, {}}) {
        for (const uint32_t z : planes)
            take(1, z);
        rolling.compute(view, outputs);
        const Result whole = compute(window);
        size_t other = 0;
        for (size_t i = 0; i < depth.size(); i++)
            other += std::abs(depth[i] - whole.depth[i]) > 600; /* 0.05 planes */
        EXPECT_LE(other, depth.size() / 50) << "after " << planes.size() << " new planes";
    }
}

/* As alignment leaves them: it smooths all planes but the middle one. */
TEST(VolumeMethod, planes_unequally_noisy_are_blurred_more)
{
    const StackShape shape{PixelFormat::Gray8, 160, 120, 5};
    const auto centre_tap = [&](float noise_of_middle) {
        TestStack stack(shape);
        std::mt19937 random(7);
        std::normal_distribution<float> grain(0.0f, 1.0f);
        for (unsigned z = 0; z < shape.planes; z++)
            for (size_t i = 0; i < size_t{shape.width} * shape.height; i++)
                stack.memory[stack.layout[z].offset + i] =
                    static_cast<std::byte>(128.5f + (z == 2 ? noise_of_middle : 5.0f) * grain(random));
        CommandQueue queue(Device::open(""));
        StackBuffer buffer(queue, shape);
        buffer.assign(stack.view());
        NoiseEstimate estimate(queue, shape, 2);
        estimate.run(buffer);
        return read_back<NoiseEstimate::Noise>(queue, estimate.noise(), 1)[0].taps[0];
    };
    EXPECT_LT(centre_tap(7.0f), centre_tap(5.0f) - 3);
}

TEST(VolumeMethod, a_scale_that_there_is_not_is_refused)
{
    DepthParameters parameters;
    parameters.method = Method::Volume;
    parameters.scale = 3;
    EXPECT_THROW(FocusEngine(Device::open(""), {PixelFormat::Gray8, 64, 64, 4}, parameters), EngineError);
}
