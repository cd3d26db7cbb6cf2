/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "align_test.h"
#include "common/stack_noise.h"
#include "common/stack_place.h"

namespace {

/* A part of each picture. */
std::vector<cv::Mat> parts_of(const ShakenStack &stack, cv::Rect where)
{
    std::vector<cv::Mat> parts;
    for (const cv::Mat &plane : stack.planes)
        parts.push_back(plane(where).clone());
    return parts;
}

} // namespace

/* For focalstackdenoise. */
TEST_F(FocalStackAlign, who_asks_is_told_where_each_stack_lies)
{
    const ShakenStack shaken({.size = {240, 200}, .planes = planes, .jitter = 1.0, .blur_step = 0.5});
    start(stack_info("I420", {160, 120}), true);
    for (const cv::Point at : {cv::Point(40, 40), {46, 32}, {20, 60}, {41, 40}}) {
        const Owned<GstBuffer> aligned = align(new_stack(info_, parts_of(shaken, {at, cv::Size(160, 120)})));
        const auto place = dff::stack_place(aligned.get());
        ASSERT_TRUE(place);
        EXPECT_EQ(place->anchor, 1U);
        EXPECT_NEAR(place->right, at.x - 40, 1);
        EXPECT_EQ(place->down, at.y - 40);
        EXPECT_GT(likeness(aligned.get(), 0, 0), 0.95);
    }

    gst_harness_push_event(harness_.get(), gst_event_new_flush_start());
    gst_harness_push_event(harness_.get(), gst_event_new_flush_stop(TRUE));
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_harness_push_event(harness_.get(), gst_event_new_segment(&segment));
    const Owned<GstBuffer> aligned = align(new_stack(info_, parts_of(shaken, {46, 32, 160, 120})));
    EXPECT_EQ(dff::stack_place(aligned.get()), (dff::StackPlace{2, 0, 0})) << "after a flush";
}

TEST_F(FocalStackAlign, where_nobody_asks_the_middle_plane_stays_as_it_is)
{
    const ShakenStack shaken({.size = {240, 200}, .planes = planes, .jitter = 1.0, .blur_step = 0.5});
    start(stack_info("GRAY8", {160, 120}));
    for (const cv::Point at : {cv::Point(40, 40), {46, 33}}) {
        const std::vector<cv::Mat> parts = parts_of(shaken, {at, cv::Size(160, 120)});
        const Owned<GstBuffer> aligned = align(new_stack(info_, parts));
        EXPECT_FALSE(dff::stack_place(aligned.get()));
        EXPECT_EQ(gst_buffer_memcmp(aligned.get(), middle * parts[middle].total(), parts[middle].data,
                                    parts[middle].total()),
                  0);
    }
}

TEST_F(FocalStackAlign, times_and_metas_stay)
{
    const ShakenStack shaken(shaking);
    start(stack_info("NV12", shaken.size));
    GstBuffer *stack = new_stack(info_, shaken.planes);
    GST_BUFFER_PTS(stack) = 5 * GST_SECOND;
    GST_BUFFER_DURATION(stack) = 40 * GST_MSECOND;
    gst_focal_stack_info_add_video_metas(&info_, stack);
    GstFocalStackMeta *meta = gst_buffer_add_focal_stack_meta(stack, 17, planes);
    meta->complete = FALSE;
    meta->missing = 2;
    GstFocusInfo focus;
    gst_focus_info_init(&focus);
    focus.power = 3.5;
    gst_focal_stack_meta_set_focus(meta, 1, &focus);
    const Owned<GstCaps> clock(gst_caps_new_empty_simple("timestamp/x-camera"));
    gst_buffer_add_reference_timestamp_meta(stack, clock.get(), 123, 456);
    dff::tell_stack_noise(stack, 3.0);

    const Owned<GstBuffer> aligned = align(stack);
    EXPECT_EQ(GST_BUFFER_PTS(aligned.get()), 5 * GST_SECOND);
    EXPECT_EQ(GST_BUFFER_DURATION(aligned.get()), 40 * GST_MSECOND);
    meta = gst_buffer_get_focal_stack_meta(aligned.get());
    ASSERT_NE(meta, nullptr);
    EXPECT_EQ(meta->sequence, 17u);
    EXPECT_FALSE(meta->complete);
    EXPECT_EQ(meta->missing, 2u);
    ASSERT_TRUE(gst_focal_stack_meta_get_focus(meta, 1, &focus));
    EXPECT_EQ(focus.power, 3.5);
    const auto *time = gst_buffer_get_reference_timestamp_meta(aligned.get(), clock.get());
    ASSERT_NE(time, nullptr);
    EXPECT_EQ(time->timestamp, 123u);
    EXPECT_FALSE(dff::stack_noise(aligned.get())); /* resampled planes have less than the others */
    EXPECT_EQ(gst_buffer_get_n_meta(aligned.get(), GST_VIDEO_META_API_TYPE), planes);
}

/* Nothing is taken from it: whoever averages stacks, or sends its planes on, must know. */
TEST_F(FocalStackAlign, a_plane_that_shows_another_scene_is_said_to_repeat_its_neighbour)
{
    ShakenStack shaken({.size = {320, 240}, .planes = planes, .blur_step = 0.5});
    start(stack_info("GRAY8", shaken.size));
    cv::rotate(shaken.planes.back(), shaken.planes.back(), cv::ROTATE_180);
    GstBuffer *stack = new_stack(info_, shaken.planes);
    gst_buffer_add_focal_stack_meta(stack, 0, planes)->repeated = 1;

    const Owned<GstBuffer> aligned = align(stack);
    EXPECT_FALSE(planes_of(stats().get()).back().trusted);
    EXPECT_EQ(gst_buffer_get_focal_stack_meta(aligned.get())->repeated, 1U | 1U << (planes - 1));
}

/* Of a gap there is no picture: nobody is warned of it, and what is known of the scene stays. */
TEST_F(FocalStackAlign, a_gap_stays_one_and_the_next_goes_on)
{
    Shaking full = shaking;
    full.size = {160, 128}; /* no bytes between rows, which nobody has written */
    const ShakenStack shaken(full);
    start(stack_info("I420", shaken.size), true);
    ASSERT_TRUE(align(new_stack(info_, shaken.planes)));
    GstBuffer *stack =
        new_stack(info_, std::vector<cv::Mat>(planes, cv::Mat(shaken.size, CV_8U, cv::Scalar(3))));
    GST_BUFFER_FLAG_SET(stack, GST_BUFFER_FLAG_GAP);
    const Owned<GstBuffer> before(gst_buffer_copy_deep(stack));
    const Owned<GstBuffer> gap = align(stack);
    EXPECT_TRUE(GST_BUFFER_FLAG_IS_SET(gap.get(), GST_BUFFER_FLAG_GAP));
    GstMapInfo map;
    gst_buffer_map(before.get(), &map, GST_MAP_READ);
    EXPECT_EQ(gst_buffer_memcmp(gap.get(), 0, map.data, map.size), 0);
    gst_buffer_unmap(before.get(), &map);
    EXPECT_FALSE(dff::stack_place(gap.get()));

    const Owned<GstBuffer> next = align(new_stack(info_, shaken.planes));
    EXPECT_FALSE(GST_BUFFER_FLAG_IS_SET(next.get(), GST_BUFFER_FLAG_GAP));
    EXPECT_EQ(dff::stack_place(next.get()), (dff::StackPlace{1, 0, 0}));
    EXPECT_EQ(count_messages(bus_, GST_MESSAGE_WARNING), 0U);
    EXPECT_EQ(number_of(stats().get(), "stacks"), 2U);
}

TEST_F(FocalStackAlign, stack_is_one_memory_of_its_own_with_slack)
{
    const ShakenStack shaken(shaking);
    start(stack_info("I420", shaken.size));
    Owned<GstBuffer> input(new_stack(info_, shaken.planes));

    const Owned<GstBuffer> aligned = align(gst_buffer_ref(input.get()));
    ASSERT_EQ(gst_buffer_n_memory(aligned.get()), 1u);
    GstMemory *memory = gst_buffer_peek_memory(aligned.get(), 0);
    EXPECT_NE(memory, gst_buffer_peek_memory(input.get(), 0));
    GstMapInfo map;
    ASSERT_TRUE(gst_memory_map(memory, &map, GST_MAP_READ));
    EXPECT_EQ((reinterpret_cast<uintptr_t>(map.data) - memory->offset) % 4096, 0u);
    gst_memory_unmap(memory, &map);
    EXPECT_EQ(memory->offset, 64u);
    EXPECT_GE(memory->maxsize, memory->offset + memory->size + 64);
    for (unsigned z = 0; z < planes; z++) {
        const GstVideoMeta *meta = gst_buffer_get_video_meta_id(aligned.get(), static_cast<gint>(z));
        ASSERT_NE(meta, nullptr);
        EXPECT_EQ(meta->offset[0], z * GST_VIDEO_INFO_SIZE(&info_.frame));
    }
}

TEST_F(FocalStackAlign, stacks_of_a_file_get_times)
{
    const ShakenStack shaken(shaking);
    start(stack_info("GRAY8", shaken.size));
    GstSegment bytes;
    gst_segment_init(&bytes, GST_FORMAT_BYTES);
    gst_harness_push_event(harness_.get(), gst_event_new_segment(&bytes));

    for (guint64 k = 0; k < 3; k++) {
        const Owned<GstBuffer> aligned = align(new_stack(info_, shaken.planes));
        EXPECT_EQ(GST_BUFFER_PTS(aligned.get()), k * 40 * GST_MSECOND);
        EXPECT_EQ(GST_BUFFER_DURATION(aligned.get()), 40 * GST_MSECOND);
    }
    g_autoptr(GstEvent) event = gst_pad_get_sticky_event(harness_->sinkpad, GST_EVENT_SEGMENT, 0);
    const GstSegment *segment = nullptr;
    gst_event_parse_segment(event, &segment);
    EXPECT_EQ(segment->format, GST_FORMAT_TIME);
}

TEST_F(FocalStackAlign, truncated_stack_is_an_error_that_names_both_sizes)
{
    start(stack_info("GRAY8", {100, 80}));

    EXPECT_EQ(gst_harness_push(harness_.get(), gst_buffer_new_allocate(nullptr, 1000, nullptr)),
              GST_FLOW_ERROR);
    const std::string message = last_error();
    EXPECT_NE(message.find("1000"), std::string::npos) << message;
    EXPECT_NE(message.find(std::to_string(gst_focal_stack_info_get_size(&info_))), std::string::npos)
        << message;
}

TEST_F(FocalStackAlign, smallest_and_longest_stacks_pass)
{
    start(stack_info("RGB", {1, 1}, 2));
    EXPECT_TRUE(align(new_stack(info_, {cv::Mat(1, 1, CV_8U, 1.0), cv::Mat(1, 1, CV_8U, 2.0)})));
    TearDown();

    const ShakenStack shaken({.size = {64, 64}, .planes = 64, .blur_step = 0.2});
    start(stack_info("I420", shaken.size, 64));
    EXPECT_TRUE(align(new_stack(info_, shaken.planes)));
    EXPECT_EQ(number_of(stats().get(), "untrusted-planes"), 0u);
}

TEST_F(FocalStackAlign, caps_may_change_between_stacks)
{
    const ShakenStack shaken(shaking);
    const ShakenStack other({.size = {96, 100}, .planes = 3, .blur_step = 0.5});
    start(stack_info("GRAY8", shaken.size));
    ASSERT_TRUE(align(new_stack(info_, shaken.planes)));

    info_ = stack_info("RGB", other.size, 3);
    const Owned<GstCaps> caps(gst_focal_stack_info_to_caps(&info_));
    gst_harness_push_event(harness_.get(), gst_event_new_caps(caps.get()));
    const Owned<GstBuffer> aligned = align(new_stack(info_, other.planes));
    EXPECT_EQ(gst_buffer_get_size(aligned.get()), gst_focal_stack_info_get_size(&info_));
    EXPECT_EQ(planes_of(stats().get()).size(), 3u);
}

TEST_F(FocalStackAlign, latency_includes_the_computation)
{
    const ShakenStack shaken(shaking);
    start(stack_info("GRAY8", shaken.size));
    gst_harness_set_upstream_latency(harness_.get(), 10 * GST_MSECOND);
    ASSERT_TRUE(align(new_stack(info_, shaken.planes)));

    EXPECT_GT(gst_harness_query_latency(harness_.get()), 10 * GST_MSECOND);
    EXPECT_EQ(count_messages(bus_, GST_MESSAGE_LATENCY), 1u);
}

TEST_F(FocalStackAlign, a_stack_outlives_its_element)
{
    const ShakenStack shaken(shaking);
    start(stack_info("GRAY8", shaken.size));
    const Owned<GstBuffer> aligned = align(new_stack(info_, shaken.planes));
    TearDown();

    EXPECT_GT(likeness(aligned.get(), 0, 0), 0.97);
}
