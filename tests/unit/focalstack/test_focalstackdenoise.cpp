/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "common/stack_noise.h"
#include "common/stack_place.h"
#include "support.h"

#include <algorithm>
#include <cmath>
#include <gst/video/video.h>
#include <gtest/gtest.h>
#include <random>

namespace {

constexpr int width = 96, height = 72, planes = 3;

GstFocalStackInfo stack_info(const char *format)
{
    GstFocalStackInfo info;
    info.planes = planes;
    info.frame = video_info(format, width, height);
    return info;
}

/* Grey of `level` with noise. */
GstBuffer *new_stack(const GstFocalStackInfo &info, guint64 sequence, int level, unsigned seed)
{
    const gsize size = gst_focal_stack_info_get_size(&info);
    GstBuffer *stack = gst_buffer_new_allocate(nullptr, size, nullptr);
    GstMapInfo map;
    gst_buffer_map(stack, &map, GST_MAP_WRITE);
    std::mt19937 random(seed);
    std::normal_distribution<float> noise(static_cast<float>(level), 5.0F);
    std::generate_n(map.data, size,
                    [&] { return static_cast<guint8>(std::clamp(noise(random), 0.0F, 255.0F)); });
    gst_buffer_unmap(stack, &map);
    gst_focal_stack_info_add_video_metas(&info, stack);
    GstFocalStackMeta *meta = gst_buffer_add_focal_stack_meta(stack, sequence, info.planes);
    meta->complete = TRUE;
    GST_BUFFER_PTS(stack) = sequence * 40 * GST_MSECOND;
    GST_BUFFER_DURATION(stack) = 40 * GST_MSECOND;
    return stack;
}

std::vector<guint8> bytes_of(GstBuffer *buffer)
{
    GstMapInfo map;
    gst_buffer_map(buffer, &map, GST_MAP_READ);
    std::vector<guint8> bytes(map.data, map.data + map.size);
    gst_buffer_unmap(buffer, &map);
    return bytes;
}

/* A stack of one component with a bright square of 16 pixels, which moves by 3 a plane. */
GstBuffer *stack_with_square(const GstFocalStackInfo &info, guint64 sequence)
{
    GstBuffer *stack = new_stack(info, sequence, 100, static_cast<unsigned>(sequence));
    GstMapInfo map;
    gst_buffer_map(stack, &map, GST_MAP_WRITE);
    const auto stride = static_cast<gsize>(GST_VIDEO_INFO_PLANE_STRIDE(&info.frame, 0));
    for (guint z = 0; z < info.planes; z++)
        for (gsize y = 30; y < 46; y++)
            memset(map.data + z * info.frame.size + y * stride + 3 * (sequence * info.planes + z), 200, 16);
    gst_buffer_unmap(stack, &map);
    return stack;
}

/* Mean square of the distance from a level. */
double noise_of(const std::vector<guint8> &bytes, int level)
{
    double sum = 0.0;
    for (const guint8 byte : bytes)
        sum += (byte - level) * (byte - level);
    return sum / static_cast<double>(bytes.size());
}

class FocalStackDenoise : public testing::Test {
protected:
    void start(const char *format, guint count = planes)
    {
        info_ = stack_info(format);
        info_.planes = count;
        harness_.reset(gst_harness_new("focalstackdenoise"));
        gst_harness_set_src_caps(harness_.get(), gst_focal_stack_info_to_caps(&info_));
    }

    Owned<GstBuffer> denoised(int level, unsigned seed)
    {
        EXPECT_EQ(gst_harness_push(harness_.get(), new_stack(info_, next_++, level, seed)), GST_FLOW_OK);
        return Owned<GstBuffer>(gst_harness_pull(harness_.get()));
    }

    GstFocalStackInfo info_{};
    Owned<GstHarness> harness_;
    guint64 next_ = 0;
};

} // namespace

TEST_F(FocalStackDenoise, metas_and_times_stay)
{
    start("I420");
    denoised(100, 1);
    const Owned<GstBuffer> stack = denoised(100, 2);
    EXPECT_EQ(GST_BUFFER_PTS(stack.get()), 40 * GST_MSECOND);
    const GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(stack.get());
    ASSERT_NE(meta, nullptr);
    EXPECT_EQ(meta->sequence, 1U);
    EXPECT_NE(gst_buffer_get_video_meta_id(stack.get(), planes - 1), nullptr);
}

TEST_F(FocalStackDenoise, noise_falls_and_stats_tell_it)
{
    start("GRAY8");
    for (unsigned seed = 0; seed < 7; seed++)
        denoised(100, seed);
    EXPECT_LT(noise_of(bytes_of(denoised(100, 7).get()), 100), 25.0 / 8 * 1.2);

    GstStructure *taken = nullptr;
    g_object_get(harness_->element, "stats", &taken, nullptr);
    const Owned<GstStructure> stats(taken);
    guint64 stacks = 0;
    double sweeps = 0.0;
    EXPECT_TRUE(gst_structure_get(stats.get(), "stacks", G_TYPE_UINT64, &stacks, "sweeps", G_TYPE_DOUBLE,
                                  &sweeps, nullptr));
    EXPECT_EQ(stacks, 8U);
    EXPECT_GT(sweeps, 7.5);
    const GValue *curve = gst_structure_get_value(stats.get(), "noise");
    ASSERT_EQ(gst_value_array_get_size(curve), 16U);
    EXPECT_NEAR(g_value_get_double(gst_value_array_get_value(curve, 6)), 5.0, 0.8);
}

/* What dffdepth believes. Of a stack whose planes are not equally noisy nothing is told. */
TEST_F(FocalStackDenoise, the_noise_that_is_left_goes_with_each_stack)
{
    start("GRAY8");
    const auto told = [](GstBuffer *stack) {
        const auto noise = dff::stack_noise(stack);
        return noise.value_or(-1.0);
    };
    EXPECT_EQ(told(denoised(100, 1).get()), -1.0);
    for (unsigned sweep = 2; sweep < 6; sweep++)
        EXPECT_NEAR(told(denoised(100, sweep).get()), 5.0 / std::sqrt(sweep), 0.8) << "sweep " << sweep;

    GstBuffer *stack = new_stack(info_, next_++, 100, 6);
    gst_buffer_get_focal_stack_meta(stack)->missing = 2;
    gst_harness_push(harness_.get(), stack);
    EXPECT_EQ(told(Owned<GstBuffer>(gst_harness_pull(harness_.get())).get()), -1.0);

    EXPECT_NEAR(told(denoised(180, 7).get()), 5.0, 0.8) << "after a cut";
}

TEST_F(FocalStackDenoise, a_stack_that_somebody_else_holds_is_not_changed)
{
    start("GRAY8");
    denoised(100, 1);
    const Owned<GstBuffer> held(new_stack(info_, next_++, 100, 2));
    const std::vector<guint8> before = bytes_of(held.get());
    gst_harness_push(harness_.get(), gst_buffer_ref(held.get()));
    const Owned<GstBuffer> stack(gst_harness_pull(harness_.get()));
    EXPECT_EQ(bytes_of(held.get()), before);
    EXPECT_NE(bytes_of(stack.get()), before);
}

TEST_F(FocalStackDenoise, nothing_before_a_flush_is_averaged_with_what_comes_after)
{
    start("GRAY8");
    denoised(100, 1);
    gst_harness_push_event(harness_.get(), gst_event_new_flush_start());
    gst_harness_push_event(harness_.get(), gst_event_new_flush_stop(TRUE));
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_harness_push_event(harness_.get(), gst_event_new_segment(&segment));
    const Owned<GstBuffer> unchanged(new_stack(info_, next_, 100, 2));
    EXPECT_EQ(bytes_of(denoised(100, 2).get()), bytes_of(unchanged.get()));
}

TEST_F(FocalStackDenoise, new_caps_begin_anew)
{
    start("GRAY8");
    denoised(100, 1);
    for (const char *format : {"RGB", "GRAY16_LE", "NV12", "RGBA64_LE"}) {
        info_ = stack_info(format);
        gst_harness_set_src_caps(harness_.get(), gst_focal_stack_info_to_caps(&info_));
        const Owned<GstBuffer> unchanged(new_stack(info_, next_, 100, 2));
        EXPECT_EQ(bytes_of(denoised(100, 2).get()), bytes_of(unchanged.get())) << format;
    }
}

TEST_F(FocalStackDenoise, a_lost_plane_stays_as_it_is)
{
    start("GRAY8");
    denoised(100, 1);
    GstBuffer *stack = new_stack(info_, next_++, 100, 2);
    gst_buffer_get_focal_stack_meta(stack)->missing = 2; /* plane 1 */
    const std::vector<guint8> before = bytes_of(stack);
    gst_harness_push(harness_.get(), stack);
    const std::vector<guint8> after = bytes_of(Owned<GstBuffer>(gst_harness_pull(harness_.get())).get());
    const auto plane = static_cast<std::ptrdiff_t>(info_.frame.size);
    EXPECT_FALSE(std::equal(before.begin(), before.begin() + plane, after.begin()));
    EXPECT_TRUE(std::equal(before.begin() + plane, before.begin() + 2 * plane, after.begin() + plane));
}

/* Of a gap there is no picture: dffdepth makes no depth of it. */
TEST_F(FocalStackDenoise, a_gap_stays_one_and_the_next_goes_on)
{
    for (const bool local_motion : {false, true}) {
        start("GRAY8", 6);
        g_object_set(harness_->element, "local-motion", static_cast<gboolean>(local_motion), nullptr);
        for (unsigned seed = 0; seed < 7; seed++)
            denoised(100, seed);
        GstBuffer *gap = new_stack(info_, next_++, 0, 1);
        GST_BUFFER_FLAG_SET(gap, GST_BUFFER_FLAG_GAP);
        const std::vector<guint8> before = bytes_of(gap);
        gst_harness_push(harness_.get(), gap);
        const Owned<GstBuffer> passed(gst_harness_pull(harness_.get()));
        EXPECT_TRUE(GST_BUFFER_FLAG_IS_SET(passed.get(), GST_BUFFER_FLAG_GAP));
        EXPECT_FALSE(dff::stack_noise(passed.get()));
        EXPECT_EQ(bytes_of(passed.get()), before);
        const Owned<GstBuffer> next = denoised(100, 7);
        EXPECT_FALSE(GST_BUFFER_FLAG_IS_SET(next.get(), GST_BUFFER_FLAG_GAP));
        EXPECT_LT(noise_of(bytes_of(next.get()), 100), 25.0 / 8 * 1.2);
    }
}

/* Nothing moves, so that all is as without it. */
TEST_F(FocalStackDenoise, local_motion_goes_on_after_a_lost_plane)
{
    std::vector<std::vector<guint8>> seen[2];
    for (const bool local_motion : {false, true}) {
        start("I420");
        next_ = 0;
        g_object_set(harness_->element, "local-motion", static_cast<gboolean>(local_motion), nullptr);
        for (unsigned seed = 0; seed < 6; seed++) {
            GstBuffer *stack = new_stack(info_, next_++, 100, seed);
            gst_buffer_get_focal_stack_meta(stack)->missing = seed == 3 ? 2 : 0;
            gst_harness_push(harness_.get(), stack);
            seen[local_motion ? 1 : 0].push_back(
                bytes_of(Owned<GstBuffer>(gst_harness_pull(harness_.get())).get()));
        }
    }
    EXPECT_EQ(seen[0], seen[1]);
}

TEST_F(FocalStackDenoise, motion_is_followed_in_the_next_sweep_after_a_lost_plane)
{
    start("GRAY8", 6);
    g_object_set(harness_->element, "local-motion", TRUE, nullptr);
    for (guint64 sweep = 0; sweep < 4; sweep++) {
        GstBuffer *stack = stack_with_square(info_, sweep);
        gst_buffer_get_focal_stack_meta(stack)->missing = sweep == 2 ? 2 : 0;
        gst_harness_push(harness_.get(), stack);
        gst_buffer_unref(gst_harness_pull(harness_.get()));
    }
    GstStructure *taken = nullptr;
    g_object_get(harness_->element, "stats", &taken, nullptr);
    const Owned<GstStructure> stats(taken);
    double moved = 0.0;
    EXPECT_TRUE(gst_structure_get_double(stats.get(), "moved", &moved));
    EXPECT_GT(moved, 0.0);
}

TEST_F(FocalStackDenoise, sweeps_of_few_planes_are_denoised_and_not_followed)
{
    for (const guint count : {2U, 3U, 4U}) {
        std::vector<std::vector<guint8>> seen[2];
        for (const bool local_motion : {false, true}) {
            start("GRAY8", count);
            g_object_set(harness_->element, "local-motion", static_cast<gboolean>(local_motion), nullptr);
            for (guint64 sweep = 0; sweep < 6; sweep++) {
                gst_harness_push(harness_.get(), stack_with_square(info_, sweep));
                seen[local_motion ? 1 : 0].push_back(
                    bytes_of(Owned<GstBuffer>(gst_harness_pull(harness_.get())).get()));
            }
        }
        EXPECT_EQ(seen[0], seen[1]) << count << " planes";
    }
}

TEST_F(FocalStackDenoise, frames_can_be_changed_while_it_plays)
{
    start("GRAY8");
    for (unsigned seed = 0; seed < 4; seed++)
        denoised(100, seed);
    g_object_set(harness_->element, "frames", 1U, nullptr);
    const Owned<GstBuffer> unchanged(new_stack(info_, next_, 100, 9));
    EXPECT_EQ(bytes_of(denoised(100, 9).get()), bytes_of(unchanged.get()));
}

/* Hot and dead: 96 x 72 pixels, luma and the chroma that belongs to it. */
TEST_F(FocalStackDenoise, bad_pixels_of_the_sensor_are_left_out_and_counted)
{
    start("I420", 6);
    const std::vector<std::pair<int, int>> places = {{30, 20}, {71, 50}};
    std::vector<guint8> bytes;
    for (unsigned seed = 0; seed < 6; seed++) {
        GstBuffer *stack = new_stack(info_, next_++, 100, seed);
        GstMapInfo map;
        gst_buffer_map(stack, &map, GST_MAP_WRITE);
        for (guint z = 0; z < info_.planes; z++)
            for (const auto &[x, y] : places) {
                guint8 *at = map.data + z * info_.frame.size + y * width + x;
                for (int j = -5; j <= 5; j++) /* something passes */
                    std::fill_n(at + j * width - 5, 11, static_cast<guint8>(seed % 2 == 0 ? 160 : 100));
                *at = y == 20 ? 255 : 0;
            }
        gst_buffer_unmap(stack, &map);
        gst_harness_push(harness_.get(), stack);
        bytes = bytes_of(Owned<GstBuffer>(gst_harness_pull(harness_.get())).get());
    }
    for (guint z = 0; z < info_.planes; z++)
        for (const auto &[x, y] : places)
            EXPECT_NEAR(bytes[z * info_.frame.size + y * width + x], 100, 15) << "plane " << z;
    GstStructure *taken = nullptr;
    g_object_get(harness_->element, "stats", &taken, nullptr);
    const Owned<GstStructure> stats(taken);
    guint64 bad = 0;
    EXPECT_TRUE(gst_structure_get(stats.get(), "bad-pixels", G_TYPE_UINT64, &bad, nullptr));
    EXPECT_EQ(bad, 2U);
}

/* A slope that moves by 6 and 4 pixels from stack to stack, as the meta tells, or another anchor each time.
 */
TEST_F(FocalStackDenoise, what_is_told_to_lie_elsewhere_is_averaged_there)
{
    for (const bool is_told : {true, false}) {
        start("GRAY8");
        std::vector<guint8> bytes;
        for (int t = 0; t < 8; t++) {
            GstBuffer *stack = new_stack(info_, next_++, 60, static_cast<unsigned>(t));
            GstMapInfo map;
            gst_buffer_map(stack, &map, GST_MAP_WRITE);
            for (gsize i = 0; i < map.size; i++)
                map.data[i] += static_cast<guint8>((i % width + 6 * t) / 2 + (i / width % height + 4 * t));
            gst_buffer_unmap(stack, &map);
            dff::tell_stack_place(stack, {static_cast<guint>(is_told ? 1 : t), 6 * t, 4 * t});
            gst_harness_push(harness_.get(), stack);
            bytes = bytes_of(Owned<GstBuffer>(gst_harness_pull(harness_.get())).get());
        }
        double sum = 0.0;
        for (int y = 8; y < 24; y++)
            for (int x = 8; x < 32; x++) {
                const double error = bytes[static_cast<size_t>(y * width + x)] - (60 + (x + 42) / 2 + y + 28);
                sum += error * error / (16 * 24);
            }
        if (is_told) {
            EXPECT_LT(sum, 25.0 / 8 * 1.5);
        } else {
            EXPECT_GT(sum, 15.0);
        }
    }
}

namespace {

/* Sweeps that are averaged at the end of a pipeline. */
double sweeps_at_the_end(const std::string &description)
{
    g_autoptr(GError) error = nullptr;
    g_autoptr(GstElement) pipeline = gst_parse_launch(description.c_str(), &error);
    EXPECT_EQ(error, nullptr) << error->message;
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline);
    g_autoptr(GstMessage) end = gst_bus_timed_pop_filtered(
        bus, 60 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
    EXPECT_TRUE(end && GST_MESSAGE_TYPE(end) == GST_MESSAGE_EOS);
    g_autoptr(GstElement) denoise = gst_bin_get_by_name(GST_BIN(pipeline), "denoise");
    GstStructure *taken = nullptr;
    g_object_get(denoise, "stats", &taken, nullptr);
    const Owned<GstStructure> stats(taken);
    double sweeps = 0.0;
    gst_structure_get_double(stats.get(), "sweeps", &sweeps);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    return sweeps;
}

} // namespace

TEST(FocalStackDenoiseOfAHand, focalstackalign_before_it_finds_the_same_places_again)
{
    const std::string camera = "lenssweeptestsrc num-buffers=48 planes=6 shake=2 noise=strong ! "
                               "video/x-raw,format=I420,width=320,height=240 ! focalstackmux ! ";
    EXPECT_GT(
        sweeps_at_the_end(camera + "focalstackalign ! queue ! focalstackdenoise name=denoise ! fakesink"),
        3.5);
    EXPECT_LT(sweeps_at_the_end(camera + "focalstackdenoise name=denoise ! fakesink"), 2.5);
}

TEST_F(FocalStackDenoise, a_stack_that_is_too_short_is_an_error_that_says_so)
{
    start("GRAY8");
    const Owned<GstBuffer> whole(new_stack(info_, 0, 100, 1));
    GstBus *bus = gst_bus_new();
    gst_element_set_bus(harness_->element, bus);
    GstBuffer *part = gst_buffer_copy_region(whole.get(), GST_BUFFER_COPY_MEMORY, 0, 1000);
    EXPECT_EQ(gst_harness_push(harness_.get(), part), GST_FLOW_ERROR);
    EXPECT_EQ(count_messages(bus, GST_MESSAGE_ERROR), 1U);
    gst_element_set_bus(harness_->element, nullptr);
    gst_object_unref(bus);
}
