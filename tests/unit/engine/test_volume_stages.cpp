/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Each kernel of method=volume against its twin, fed with what the device's stage before it gave. */
#include "noisy_stack.h"
#include "volume_stages.h"

#include <random>

using namespace dff;

TEST_P(VolumeStages, evidence_agrees_with_its_twins)
{
    expect_noise_as_made();
    expect_small_planes_and_focus_volume();
    expect_even_noise();
    expect_cost_volume();
}

/* Whoever has averaged sweeps knows it better than one stack shows it. */
TEST(NoiseEstimate, what_is_told_is_believed)
{
    const StackShape shape{PixelFormat::Gray8, 160, 120, 4};
    const TestStack stack(shape);
    CommandQueue queue(Device::open(""));
    StackBuffer buffer(queue, shape);
    NoiseEstimate estimate(queue, shape, 2);
    const auto sigma = [&](std::optional<float> told) {
        StackView view = stack.view();
        view.noise = told;
        buffer.assign(view);
        estimate.run(buffer);
        NoiseEstimate::Noise noise{};
        queue.commands().enqueueReadBuffer(estimate.noise(), CL_TRUE, 0, sizeof noise, &noise);
        EXPECT_FLOAT_EQ(noise.t, noise.sigma * noise.sigma / (noise.sigma * noise.sigma + 1.0F));
        return noise.sigma;
    };
    const float alone = sigma(std::nullopt);
    EXPECT_FLOAT_EQ(sigma(2.5F), 2.5F);
    EXPECT_FLOAT_EQ(sigma(0.0F), 0.0F);
    EXPECT_FLOAT_EQ(sigma(std::nullopt), alone);
}

/* Of a rolling window, whose planes come one by one. */
TEST(NoiseEstimate, planes_that_came_while_noise_was_told_are_measured_when_it_is_not)
{
    const StackShape shape{PixelFormat::Gray8, 160, 120, 3};
    CommandQueue queue(Device::open(""));
    StackBuffer buffer(queue, shape);
    NoiseEstimate rolling(queue, shape, 2), fresh(queue, shape, 2);
    const auto sigma = [&](NoiseEstimate &estimate, const StackBuffer &stack) {
        estimate.run(stack);
        NoiseEstimate::Noise noise{};
        queue.commands().enqueueReadBuffer(estimate.noise(), CL_TRUE, 0, sizeof noise, &noise);
        return noise.sigma;
    };
    TestStack stack = noisy(smooth_stack(shape), 12.0, 1);
    StackView view = stack.view();
    view.identities = {PlaneIdentity{0, 0}, PlaneIdentity{0, 1}, PlaneIdentity{0, 2}};
    for (unsigned z = 0; z < shape.planes; z++) {
        const TestStack later = noisy(smooth_stack(shape), 3.0, 2 + z);
        std::copy_n(later.memory.begin() + static_cast<std::ptrdiff_t>(later.layout[z].offset),
                    later.layout[z].stride * shape.height,
                    stack.memory.begin() + static_cast<std::ptrdiff_t>(stack.layout[z].offset));
        view.identities[z] = PlaneIdentity{1, z};
        view.noise = z + 1 < shape.planes ? std::optional(4.0F) : std::nullopt;
        buffer.assign(view);
        EXPECT_EQ(buffer.changed_planes(), z == 0 ? uint64_t{7} : uint64_t{1} << z);
        if (view.noise)
            EXPECT_FLOAT_EQ(sigma(rolling, buffer), 4.0F);
        else
            EXPECT_FLOAT_EQ(sigma(rolling, buffer), sigma(fresh, buffer.as_new()));
        buffer.remember(view);
    }
}

/* A dark bag, a desk that has texture everywhere, and a bright blank wall, which is a little brighter from
 * plane to plane: what the desk has is no noise that the wall lacks. */
TEST(NoiseFloor, what_a_brighter_place_lacks_is_no_noise)
{
    const StackShape shape{PixelFormat::Gray8, 240, 120, 4};
    TestStack stack(shape);
    std::mt19937 random(7);
    for (unsigned z = 0; z < shape.planes; z++)
        for (unsigned y = 0; y < shape.height; y++)
            for (unsigned x = 0; x < shape.width; x++) {
                const unsigned darkest = x < 80 ? 20 : x < 160 ? 80 : 200 + 3 * z;
                const unsigned spread = x < 80 ? 15 : x < 160 ? 41 : 5;
                stack.memory[stack.layout[z].offset + stack.layout[z].stride * y + x] =
                    static_cast<std::byte>(darkest + random() % spread);
            }
    CommandQueue queue(Device::open(""));
    StackBuffer buffer(queue, shape);
    buffer.assign(stack.view());
    const LowShape low(shape, 2);
    NoiseEstimate noise(queue, shape, low.scale);
    SmallPlanes small(queue, shape, low);
    FocusVolume focus(queue, shape, low);
    NoiseFloor floor(queue, low);
    noise.run(buffer);
    small.run(buffer);
    focus.run(buffer, noise);
    const cl::Buffer &evened = floor.run(focus, small, noise);
    const size_t cells = size_t{shape.planes} * low.height * low.stride;
    const auto as_measured = read_back<cl_short>(queue, focus.volume(), cells);
    const auto found = read_back<cl_short>(queue, evened, cells);
    for (size_t row = 0; row < size_t{shape.planes} * low.height; row++)
        for (int x = low.width * 2 / 3 + 2; x < low.width; x++) /* the wall */
            ASSERT_EQ(found[row * low.stride + LowShape::side + x],
                      as_measured[row * low.stride + LowShape::side + x])
                << row << "," << x;
}

/* Falls as photographs of a circuit board have them, farther apart by 16 to 20 pixels: glints keep the finest
 * scale from falling to nothing, and the next one is as narrow. */
TEST(BlurStep, scales_that_rise_later_tell_it)
{
    const std::vector<BlurStep::Fall> board{
        {1.0f, 0.256f, 1.0f}, {4.0f, 0.275f, 1.0f}, {8.0f, 0.577f, 1.0f}, {16.0f, 0.840f, 1.0f}};
    EXPECT_NEAR(BlurStep::step_of(board), 18.0f, 2.0f);
}

/* What falls alike on all scales is no blur. */
TEST(BlurStep, nothing_that_rises_is_read_on_the_finest_scale)
{
    const std::vector<BlurStep::Fall> alike{
        {1.0f, 0.30f, 1.0f}, {4.0f, 0.32f, 1.0f}, {8.0f, 0.35f, 1.0f}, {16.0f, 0.37f, 1.0f}};
    EXPECT_NEAR(BlurStep::step_of(alike), 4.0f, 0.1f);
}

TEST_P(VolumeStages, decision_agrees_with_its_twins)
{
    run_to_matching();
    expect_guide_image();
    expect_guided_filter_and_matching();
    expect_fill_and_upsampling();
    expect_confidence_and_sparse_depth();
    expect_doubt();
}

TEST_P(VolumeStages, what_follows_the_blur_agrees_with_its_twins)
{
    expect_pyramid();
    expect_falls();
    expect_no_leak();
    run_to_matching();
    expect_occlusion_doubt();
    expect_sub_plane();
}

TEST_P(VolumeStages, what_is_seen_through_agrees_with_its_twin)
{
    expect_seen_through(Prefer::Near);
    expect_seen_through(Prefer::Far);
}

Volume VolumeStages::read_level(const cl::Buffer &buffer_on_device, const LowShape &level, float one)
{
    const LowShape finest = low;
    low = level;
    Volume found = read_shorts(buffer_on_device, shape.planes, one);
    low = finest;
    return found;
}

void VolumeStages::expect_pyramid()
{
    Volume luma = twin::mean_of_small(read_small());
    for (const FocusPyramid::Level &level : pyramid.levels()) {
        const Volume found = read_level(level.luma, level.shape, 16);
        expect_alike(found, luma, 0.2f);
        expect_alike(read_level(level.focus, level.shape, 32), twin::focus_on_scale(found, noise.t), 0.7f);
        luma = twin::average_squares(found, 2);
    }
}

void VolumeStages::expect_falls()
{
    const BlurStep::Blur blur = blur_stage.read(focus_stage, pyramid, noise_stage, {});
    EXPECT_FLOAT_EQ(blur.t, noise.t);
    const std::vector<BlurStep::Fall> &falls = blur_stage.falls();
    ASSERT_EQ(falls.size(), pyramid.levels().size() + 1);
    EXPECT_NEAR(falls[0].rho, twin::fall_beside_peaks(read_shorts(focus_stage.volume(), shape.planes, 32)),
                0.06f);
    for (size_t i = 1; i < falls.size(); i++) {
        const FocusPyramid::Level &level = pyramid.levels()[i - 1];
        EXPECT_EQ(falls[i].scale, static_cast<float>(level.shape.scale));
        EXPECT_NEAR(falls[i].rho, twin::fall_beside_peaks(read_level(level.focus, level.shape, 32)), 0.06f);
    }
}

void VolumeStages::expect_no_leak()
{
    cost_stage.run_fine(focus_stage.volume(), noise_stage);
    cost_stage.run_coarse(small_stage, noise_stage, close_planes);
    const Volume focus = read_shorts(cost_stage.coarse_focus(), shape.planes, 32);
    const Volume smooth = twin::smooth_along_z(focus, noise.t);
    const float middle =
        twin::median(twin::top_of(smooth).values) - 0.5f * twin::median(twin::range_of(smooth).values);
    cost_stage.run_coarse(small_stage, noise_stage, far_planes);
    expect_alike(read_shorts(cost_stage.coarse_focus(), shape.planes, 32),
                 twin::without_leak(focus, middle, far_planes, low.scale, noise.t), 0.3f);
}

/* Of steps in depth, since what is decided has none here. */
void VolumeStages::expect_occlusion_doubt()
{
    std::vector<float> cells(size_t{1} * low.height * low.stride);
    for (int y = 0; y < low.height; y++)
        for (int x = -LowShape::side; x < low.width + LowShape::side; x++) {
            const int column = x < 0 ? -1 - x : x < low.width ? x : 2 * low.width - 1 - x;
            const int step = (column / 13 + y / 11) % 5;
            cells[y * low.stride + LowShape::side + x] =
                static_cast<float>(step) * static_cast<float>(shape.planes - 1) / 4.0f;
        }
    queue.commands().enqueueWriteBuffer(matching.u(), CL_TRUE, 0, cells.size() * sizeof(float), cells.data());
    const Volume u = read(matching.u(), 1), confidence = read(matching.confidence(), 1);
    const Volume cost = read_shorts(filter_stage.filtered(), shape.planes, 1024);
    doubt_stage.run(matching, filter_stage.filtered(), noise_stage, far_planes);
    const Volume doubted = read(matching.confidence(), 1);
    expect_mostly(doubted, twin::doubt_nearer_side(confidence, u, cost, far_planes, low.scale, noise.t),
                  5e-3f);
    EXPECT_TRUE(shape.planes == 2 || doubted.values != confidence.values);
}

/* Of costs that rise and fall as they like. */
void VolumeStages::expect_seen_through(Prefer prefer)
{
    cost_stage.run_fine(focus_stage.volume(), noise_stage);
    std::vector<cl_short> cells(size_t{1} * shape.planes * low.height * low.stride);
    std::mt19937 random(7);
    std::uniform_int_distribution<int> costs(0, 1433);
    for (cl_short &cell : cells)
        cell = static_cast<cl_short>(costs(random));
    queue.commands().enqueueWriteBuffer(cost_stage.cost(), CL_TRUE, 0, cells.size() * sizeof(cl_short),
                                        cells.data());
    const Volume cost = read_shorts(cost_stage.cost(), shape.planes, 1);
    const Volume top = read_cells<float>(cost_stage.top(), 1.0f / 32, 1);
    const float median = read_back<float>(queue, cost_stage.median_top(), 1)[0];
    SeenThrough(queue, low).run(cost_stage, noise_stage, prefer);
    const Volume found = read_shorts(cost_stage.cost(), shape.planes, 1);
    expect_mostly(found, twin::prefer(cost, top, median, noise.t, prefer == Prefer::Far), 0.5f);
    EXPECT_TRUE(shape.planes < 3 || found.values != cost.values);
}

void VolumeStages::expect_sub_plane()
{
    if (shape.planes < 3)
        return;
    const Volume u = read(matching.u(), 1);
    const auto refined = [&](float blur_step) {
        const cl::Buffer placed = low.allocate(queue, 1);
        queue.commands().enqueueCopyBuffer(matching.u(), placed, 0, 0,
                                           sizeof(cl_float) * size_t{1} * low.height * low.stride);
        sub_plane_stage.run(placed, focus_stage, pyramid, noise_stage, blur_step);
        return read(placed, 1);
    };
    for (const FocusPyramid::Level &level : pyramid.levels())
        expect_mostly(refined(2.0f * static_cast<float>(level.shape.scale)),
                      twin::refine(u, read_level(level.focus, level.shape, 32), 1, noise.t), 0.03f);
    const Volume finest = read_shorts(focus_stage.volume(), shape.planes, 32);
    expect_mostly(refined(1.5f), twin::refine(u, finest, shape.planes >= 5 ? 2 : 1, noise.t), 0.03f);
}

void VolumeStages::expect_noise_as_made()
{
    if (GetParam().silent)
        EXPECT_LT(noise.t, 0.3f);
    else
        EXPECT_GT(noise.t, 0.9f);
    EXPECT_EQ(noise.taps[0] + 2 * (noise.taps[1] + noise.taps[2] + noise.taps[3]), 64);
}

void VolumeStages::expect_small_planes_and_focus_volume()
{
    const twin::Colours small = read_small();
    const Volume luma = twin::mean_of_colours(stack);
    const Volume small_luma = twin::average_squares(luma, low.scale);
    if (shape.format != PixelFormat::I420 && shape.format != PixelFormat::Nv12)
        for (size_t i = 0; i < small_luma.values.size(); i++)
            ASSERT_NEAR((small[0].values[i] + small[1].values[i] + small[2].values[i]) / 3.0f,
                        small_luma.values[i], 0.1f);
    else /* Y is a weighted sum of R, G, B */
        for (size_t i = 0; i < small_luma.values.size(); i++)
            ASSERT_NEAR(0.299f * small[0].values[i] + 0.587f * small[1].values[i] +
                            0.114f * small[2].values[i],
                        small_luma.values[i], 0.3f);
    expect_alike(read_shorts(focus_stage.volume(), shape.planes, 32),
                 twin::fine_focus(luma, noise, low.scale), noise.taps[0] == 64 ? 0.2f : 0.6f, 3);
}

void VolumeStages::expect_even_noise()
{
    const cl::Buffer &evened = floor_stage.run(focus_stage, small_stage, noise_stage);
    const auto curve = read_back<float>(queue, floor_stage.curve(), 5);
    const Volume focus = read_shorts(focus_stage.volume(), shape.planes, 32);
    const std::vector<float> expected = twin::noise_curve(focus, read_small());
    const std::vector<float> limited =
        twin::not_fallen_deep({curve[0], curve[1], curve[2], expected[3], expected[4]});
    EXPECT_FLOAT_EQ(curve[3], limited[3]);
    EXPECT_FLOAT_EQ(curve[4], limited[4]);
    const auto at = [](const std::vector<float> &c, float i) { return c[0] + i * (c[1] + i * c[2]); };
    for (const float i : {expected[3], 0.5f * (expected[3] + expected[4]), expected[4]})
        EXPECT_NEAR(at(curve, i), at(expected, i), 0.05f * std::abs(at(expected, i)) + 1.0f);
    expect_alike(read_shorts(evened, shape.planes, 32), twin::even_noise(focus, read_small(), curve, noise.t),
                 0.06f);
}

void VolumeStages::expect_cost_volume()
{
    const twin::Colours small = read_small();
    cost_stage.run_fine(focus_stage.volume(), noise_stage);
    const Volume fine = twin::smooth_along_z(read_shorts(focus_stage.volume(), shape.planes, 32), noise.t);
    const Volume fine_cost = twin::fine_cost(fine, twin::median(twin::top_of(fine).values), noise.t);
    const Volume found = read_shorts(cost_stage.cost(), shape.planes, 1024);
    expect_alike(found, fine_cost, 0.02f);

    cost_stage.run_coarse(small_stage, noise_stage, close_planes);
    const Volume coarse = twin::smooth_along_z(twin::coarse_focus(small), noise.t);
    const float median_fine_range = twin::median(twin::range_of(fine).values),
                median_range = twin::median(twin::range_of(coarse).values);
    const Volume cost = read_shorts(cost_stage.cost(), shape.planes, 1024);
    expect_alike(cost, twin::cost(fine_cost, fine, coarse, median_fine_range, median_range, noise.t), 0.03f,
                 2);

    cost_stage.run_guess(noise_stage);
    const Volume wide = read_shorts(cost_stage.wide_focus(), shape.planes, 32);
    expect_alike(wide,
                 twin::widen(read_shorts(cost_stage.coarse_focus(), shape.planes, 32),
                             CostVolume::guess_spacing(low.width)),
                 0.3f);
    expect_mostly(
        read_shorts(cost_stage.first_guess(), 1, 1),
        twin::first_guess(cost, fine, twin::smooth_along_z(wide, noise.t), median_fine_range, median_range),
        0.0f);
}

void VolumeStages::expect_guide_image()
{
    const twin::Colours small = read_small();
    const Volume u = read(guide_stage.nearer(), 1);
    expect_alike(u, twin::nearest_3x3(twin::median_5x5(read_shorts(cost_stage.first_guess(), 1, 1))), 0.0f);
    const twin::Colours guide = twin::denoise(twin::blend(small, u, noise.t), noise.sigma, low.scale);
    const twin::Colours found = read_guide();
    for (size_t c = 0; c < 3; c++)
        expect_alike(found[c], guide[c], 0.5f);
}

void VolumeStages::expect_guided_filter_and_matching()
{
    const twin::Colours guide = read_guide();
    const Volume cost = read_shorts(cost_stage.cost(), shape.planes, 1024);
    filter_stage.run(cost_stage.cost(), guide_stage.guide(), noise_stage);
    const Volume undoubted = read_shorts(filter_stage.filtered(), shape.planes, 1024);
    expect_alike(undoubted, twin::guided_filter(cost, guide, noise.t), 0.01f);

    filter_stage.doubt(guide_stage.nearer(), noise_stage);
    const Volume filtered = read_shorts(filter_stage.filtered(), shape.planes, 1024);
    expect_alike(filtered, twin::doubt_nearer(undoubted, read(guide_stage.nearer(), 1), noise.t), 1e-3f);

    expect_mostly(read(matching.u(), 1), twin::decide(twin::match(filtered, guide, noise.t), noise.t), 0.05f);
    expect_alike(read(matching.confidence(), 1), twin::mean_over_planes(filtered), 4e-3f);
}

/* Of surroundings from the nearest plane to behind the farthest, so that every cell may be doubted. */
void VolumeStages::expect_doubt()
{
    filter_stage.run(cost_stage.cost(), guide_stage.guide(), noise_stage);
    const Volume undoubted = read_shorts(filter_stage.filtered(), shape.planes, 1024);
    const float farthest = static_cast<float>(shape.planes + 1);
    std::vector<float> cells(size_t{1} * low.height * low.stride);
    for (size_t i = 0; i < cells.size(); i++)
        cells[i] = farthest * static_cast<float>(i % 16) / 15.0f;
    const cl::Buffer surroundings = low.allocate(queue, 1);
    queue.commands().enqueueWriteBuffer(surroundings, CL_TRUE, 0, cells.size() * sizeof(float), cells.data());

    filter_stage.doubt(surroundings, noise_stage);
    const Volume doubted = read_shorts(filter_stage.filtered(), shape.planes, 1024);
    expect_alike(doubted, twin::doubt_nearer(undoubted, read(surroundings, 1), noise.t), 1e-3f);
    if (GetParam().silent) {
        EXPECT_NE(doubted.values, undoubted.values);
    }
}

void VolumeStages::expect_fill_and_upsampling()
{
    const twin::Colours guide = read_guide();
    const Volume u = read(matching.u(), 1), confidence = read(matching.confidence(), 1);
    const float blur_step = GetParam().silent ? far_planes : close_planes;
    uncertainty_stage.remember_matched(guide_stage.nearer()); /* for one that differs everywhere */
    const Volume matched = read(guide_stage.nearer(), 1);
    uncertainty_stage.remember_decided(matching.u());
    fill_stage.run(matching, noise.t, blur_step);
    const float high = read_back<float>(queue, fill_stage.high_confidence(), 1)[0];
    const Volume filled = read(matching.u(), 1);
    expect_alike(filled, twin::fill(u, confidence, guide, high, noise.t, blur_step), 0.05f);

    guide_stage.run_at(matching.u(), small_stage, noise_stage);
    upsampling.run(matching.u(), guide_stage, cost_stage, noise_stage, buffer, coder, depth_map);
    expect_uncertainty(u, matched);
    if (shape.format == PixelFormat::I420 || shape.format == PixelFormat::Nv12)
        return; /* its pixels' colours are what the small planes' are: tried above */
    twin::Colours planes{Volume(shape.width, shape.height, shape.planes),
                         Volume(shape.width, shape.height, shape.planes),
                         Volume(shape.width, shape.height, shape.planes)};
    const cl_int4 channels = colour_channels(shape.format);
    for (unsigned z = 0; z < shape.planes; z++)
        for (unsigned y = 0; y < shape.height; y++)
            for (unsigned x = 0; x < shape.width; x++)
                for (unsigned c = 0; c < 3; c++)
                    planes[c].at(x, y, z) = !is_interleaved(shape.format)
                                                ? stack.dn(0, x, y, z)
                                                : stack.dn(0, x * channels.s[0] + channels.s[c + 1], y, z);
    const Volume expected = twin::upsample(filled, read_guide(), planes, noise.t, low.scale);
    const auto depth = read_back<uint16_t>(queue, depth_map, expected.values.size());
    const DepthEncoder encoder = DepthEncoder::index(shape.planes);
    size_t other = 0;
    for (size_t i = 0; i < depth.size(); i++)
        other += std::abs(encoder.decode(depth[i]).value_or(-1.0) - expected.values[i]) > 0.02f;
    EXPECT_LE(other, depth.size() / 200);
}

/* After the depth map. */
void VolumeStages::expect_uncertainty(const Volume &decided, const Volume &matched)
{
    coder.set_encoder(DepthEncoder::index(shape.planes));
    uncertainty_stage.run(matching.u(), fill_stage, filter_stage.filtered(), noise_stage, coder, depth_map);
    const Volume found = read(uncertainty_stage.deviation(), 1);
    const Volume evidence = read_cells<float>(fill_stage.solved(), 1.0f, 1, 1);
    const float high = read_back<float>(queue, fill_stage.high_confidence(), 1)[0];
    const Volume expected =
        twin::deviation(read(matching.u(), 1), decided, matched, evidence, high,
                        read_shorts(filter_stage.filtered(), shape.planes, 1024), noise.t);
    for (size_t i = 0; i < expected.values.size(); i++)
        ASSERT_NEAR(found.values[i], expected.values[i], 0.03f * expected.values[i] + 1e-3f) << i;

    const size_t pixels = size_t{shape.width} * shape.height;
    const auto map = read_back<uint16_t>(queue, uncertainty_stage.map(), pixels);
    const auto depth = read_back<uint16_t>(queue, depth_map, pixels);
    const float a_plane = 65534.0f / static_cast<float>(shape.planes - 1);
    Volume shares_of_all = found; /* brought up as confidence is, in bytes */
    for (float &value : shares_of_all.values)
        value = value / static_cast<float>(shape.planes - 1);
    const auto shares = twin::upsample_confidence(shares_of_all, shape.width, shape.height, low.scale);
    for (size_t i = 0; i < pixels; i++) {
        EXPECT_EQ(map[i] == 0, depth[i] == 0);
        if (depth[i] != 0) {
            ASSERT_NEAR(static_cast<float>(map[i]) / a_plane,
                        static_cast<float>(shares[i]) / 255.0f * static_cast<float>(shape.planes - 1),
                        0.005f * static_cast<float>(shape.planes))
                << i;
        }
    }
}

void VolumeStages::expect_confidence_and_sparse_depth()
{
    const size_t pixels = size_t{shape.width} * shape.height;
    upsampling.run_confidence(matching, cost_stage);
    const auto confidence = read_back<uint8_t>(queue, upsampling.confidence(), pixels);
    const auto expected =
        twin::upsample_confidence(read(matching.confidence(), 1), shape.width, shape.height, low.scale);
    for (size_t i = 0; i < pixels; i++)
        ASSERT_NEAR(confidence[i], expected[i], 1) << i % shape.width << "," << i / shape.width;

    const auto depth = read_back<uint16_t>(queue, depth_map, pixels);
    const float high = read_back<float>(queue, fill_stage.high_confidence(), 1)[0];
    upsampling.run_sparse(depth_map, fill_stage, nullptr);
    EXPECT_EQ(read_back<uint16_t>(queue, upsampling.sparse(), pixels),
              twin::keep_confident(depth, confidence, nullptr, high));

    Luma luma(queue, shape);
    ZEntropy motion(queue, shape, 0.5f);
    luma.run(buffer);
    motion.run(luma);
    const auto moved = read_back<uint8_t>(queue, motion.moved(), pixels);
    upsampling.run_sparse(depth_map, fill_stage, &motion);
    EXPECT_EQ(read_back<uint16_t>(queue, upsampling.sparse(), pixels),
              twin::keep_confident(depth, confidence, &moved, high));
}

INSTANTIATE_TEST_SUITE_P(Volume, VolumeStages,
                         testing::Values(VolumeCase{PixelFormat::Bgr, 121, 99, 6, 2, false},
                                         VolumeCase{PixelFormat::Rgbx, 160, 131, 10, 4, true},
                                         VolumeCase{PixelFormat::Gray8, 163, 128, 5, 4, true},
                                         VolumeCase{PixelFormat::Gray16, 90, 70, 4, 2, false},
                                         VolumeCase{PixelFormat::Rgba64, 160, 131, 6, 4, true},
                                         VolumeCase{PixelFormat::Rgba64, 121, 99, 4, 2, false},
                                         VolumeCase{PixelFormat::I420, 133, 117, 4, 4, false},
                                         VolumeCase{PixelFormat::Nv12, 150, 66, 3, 2, true},
                                         VolumeCase{PixelFormat::Gray8, 256, 250, 3, 8, false},
                                         VolumeCase{PixelFormat::Gray8, 64, 64, 2, 2, false}));
