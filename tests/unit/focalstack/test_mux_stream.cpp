/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "support.h"

#include <gtest/gtest.h>

namespace {

constexpr unsigned planes = 3;

Owned<GstHarness> new_mux(const char *settings = "focalstackmux")
{
    return Owned<GstHarness>(gst_harness_new_parse(settings));
}

void push_sweep(GstHarness *harness, const GstVideoInfo &info, uint64_t sweep)
{
    for (unsigned z = 0; z < planes; z++)
        ASSERT_EQ(gst_harness_push(harness, new_frame(info, sweep, z, planes)), GST_FLOW_OK);
}

uint64_t count_in(GstHarness *harness, const char *name)
{
    GstElement *mux = gst_harness_find_element(harness, "focalstackmux");
    const uint64_t count = count_of(mux, name);
    gst_object_unref(mux);
    return count;
}

GstCaps *stack_caps(GstHarness *harness)
{
    return gst_pad_get_current_caps(harness->sinkpad);
}

/* Events that came out since last asked. */
std::vector<GstEventType> events_of(GstHarness *harness)
{
    std::vector<GstEventType> types;
    while (GstEvent *event = gst_harness_try_pull_event(harness)) {
        types.push_back(GST_EVENT_TYPE(event));
        gst_event_unref(event);
    }
    return types;
}

} // namespace

class EveryFormat : public testing::TestWithParam<const char *> {};

TEST_P(EveryFormat, every_pixel_of_odd_sized_frames_arrives)
{
    const GstVideoInfo info = video_info(GetParam(), 33, 17);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps(GetParam(), 33, 17).c_str());
    push_sweep(harness.get(), info, 5);
    const Owned<GstBuffer> stack(gst_harness_try_pull(harness.get()));
    ASSERT_TRUE(stack);
    ASSERT_EQ(gst_buffer_get_size(stack.get()), GST_VIDEO_INFO_SIZE(&info) * planes);

    for (unsigned z = 0; z < planes; z++) {
        GstVideoFrame frame;
        ASSERT_TRUE(gst_video_frame_map_id(&frame, &info, stack.get(), static_cast<int>(z), GST_MAP_READ));
        for (unsigned c = 0; c < GST_VIDEO_FRAME_N_COMPONENTS(&frame); c++)
            for (int y = 0; y < GST_VIDEO_FRAME_COMP_HEIGHT(&frame, c); y++)
                for (int x = 0; x < GST_VIDEO_FRAME_COMP_WIDTH(&frame, c); x++)
                    ASSERT_EQ(static_cast<uint8_t *>(GST_VIDEO_FRAME_COMP_DATA(
                                  &frame, c))[y * GST_VIDEO_FRAME_COMP_STRIDE(&frame, c) +
                                              x * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, c)],
                              shade(5, z));
        gst_video_frame_unmap(&frame);
    }
}

INSTANTIATE_TEST_SUITE_P(MuxStream, EveryFormat,
                         testing::Values("GRAY8", "GRAY16_LE", "I420", "NV12", "RGB", "BGR", "RGBx", "BGRx",
                                         "RGBA64_LE"));

TEST(MuxStream, caps_of_stacks_say_planes_and_stacks_a_second)
{
    const GstVideoInfo info = video_info("I420", 32, 16);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("I420", 32, 16).c_str());
    push_sweep(harness.get(), info, 0);
    g_autoptr(GstCaps) caps = stack_caps(harness.get());
    const GstStructure *structure = gst_caps_get_structure(caps, 0);
    gint n = 0;
    gint numerator = 0;
    gint denominator = 0;
    EXPECT_TRUE(gst_structure_has_name(structure, "video/x-focal-stack"));
    EXPECT_TRUE(gst_structure_get_int(structure, "planes", &n));
    EXPECT_TRUE(gst_structure_get_fraction(structure, "framerate", &numerator, &denominator));
    EXPECT_EQ(n, 3);
    EXPECT_EQ(numerator, 40);
    EXPECT_EQ(denominator, 1);
}

TEST(MuxStream, an_unknown_rate_stays_unknown)
{
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), "video/x-raw,format=GRAY8,width=32,height=16,framerate=0/1");
    push_sweep(harness.get(), info, 0);
    g_autoptr(GstCaps) caps = stack_caps(harness.get());
    GstFocalStackInfo stack;
    ASSERT_TRUE(gst_focal_stack_info_from_caps(&stack, caps));
    EXPECT_EQ(GST_VIDEO_INFO_FPS_N(&stack.frame), 0);
}

TEST(MuxStream, padded_rows_of_a_camera_are_understood)
{
    const GstVideoInfo info = video_info("GRAY8", 30, 10);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 30, 10).c_str());
    for (unsigned z = 0; z < planes; z++) {
        GstBuffer *frame = gst_buffer_new_allocate(nullptr, 64 * 10, nullptr);
        gst_buffer_memset(frame, 0, 0xee, 64 * 10);
        for (unsigned y = 0; y < 10; y++)
            gst_buffer_memset(frame, 64 * y, shade(0, z), 30);
        gsize offset[GST_VIDEO_MAX_PLANES] = {};
        gint stride[GST_VIDEO_MAX_PLANES] = {64};
        gst_buffer_add_video_meta_full(frame, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_GRAY8, 30, 10, 1,
                                       offset, stride);
        GstFocusInfo focus;
        gst_focus_info_init(&focus);
        focus.plane = z;
        focus.planes = planes;
        gst_buffer_add_focus_meta(frame, &focus);
        gst_harness_push(harness.get(), frame);
    }
    const Owned<GstBuffer> stack(gst_harness_try_pull(harness.get()));
    ASSERT_TRUE(stack);
    GstVideoFrame last;
    ASSERT_TRUE(gst_video_frame_map_id(&last, &info, stack.get(), 2, GST_MAP_READ));
    for (int y = 0; y < 10; y++)
        for (int x = 0; x < 30; x++)
            ASSERT_EQ(static_cast<uint8_t *>(GST_VIDEO_FRAME_PLANE_DATA(
                          &last, 0))[y * GST_VIDEO_FRAME_PLANE_STRIDE(&last, 0) + x],
                      shade(0, 2));
    gst_video_frame_unmap(&last);
}

TEST(MuxStream, stacks_lie_in_one_memory_with_slack_at_both_ends)
{
    const GstVideoInfo info = video_info("NV12", 32, 16);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("NV12", 32, 16).c_str());
    push_sweep(harness.get(), info, 0);
    const Owned<GstBuffer> stack(gst_harness_try_pull(harness.get()));
    ASSERT_TRUE(stack);
    ASSERT_EQ(gst_buffer_n_memory(stack.get()), 1u);
    gsize offset = 0;
    gsize most = 0;
    const gsize size = gst_memory_get_sizes(gst_buffer_peek_memory(stack.get(), 0), &offset, &most);
    EXPECT_GE(offset, 64u);
    EXPECT_GE(most - offset - size, 64u);
}

TEST(MuxStream, caps_change_between_sweeps)
{
    const GstVideoInfo small = video_info("GRAY8", 32, 16);
    const GstVideoInfo large = video_info("RGB", 64, 32);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    push_sweep(harness.get(), small, 0);
    gst_harness_set_src_caps_str(harness.get(), frame_caps("RGB", 64, 32).c_str());
    push_sweep(harness.get(), large, 1);

    const Owned<GstBuffer> first(gst_harness_try_pull(harness.get()));
    const Owned<GstBuffer> second(gst_harness_try_pull(harness.get()));
    ASSERT_TRUE(first && second);
    EXPECT_EQ(shades_of(small, first.get(), planes), shades_of_sweep(0, planes));
    EXPECT_EQ(shades_of(large, second.get(), planes), shades_of_sweep(1, planes));
    EXPECT_EQ(gst_buffer_get_focal_stack_meta(second.get())->sequence, 1u);
    EXPECT_EQ(count_in(harness.get(), "lost"), 0u);
}

TEST(MuxStream, caps_change_in_mid_sweep_never_mixes)
{
    const GstVideoInfo small = video_info("GRAY8", 32, 16);
    const GstVideoInfo large = video_info("GRAY8", 64, 32);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    gst_harness_push(harness.get(), new_frame(small, 0, 0, planes));
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 64, 32).c_str());
    for (unsigned z = 1; z < planes; z++)
        gst_harness_push(harness.get(), new_frame(large, 0, z, planes));
    push_sweep(harness.get(), large, 1);
    const Owned<GstBuffer> stack(gst_harness_try_pull(harness.get()));
    ASSERT_TRUE(stack);
    EXPECT_EQ(shades_of(large, stack.get(), planes), shades_of_sweep(1, planes));
    EXPECT_FALSE(gst_harness_try_pull(harness.get()));
    EXPECT_EQ(count_in(harness.get(), "dropped-stacks"), 2u);
}

TEST(MuxStream, the_number_of_planes_may_change)
{
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    push_sweep(harness.get(), info, 0);
    for (unsigned z = 0; z < 5; z++)
        gst_harness_push(harness.get(), new_frame(info, 1, z, 5));
    Owned<GstBuffer>(gst_harness_try_pull(harness.get()));
    const Owned<GstBuffer> longer(gst_harness_try_pull(harness.get()));
    ASSERT_TRUE(longer);
    EXPECT_EQ(shades_of(info, longer.get(), 5), shades_of_sweep(1, 5));
}

TEST(MuxStream, a_flush_leaves_nothing_of_the_old_sweep)
{
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    gst_harness_push(harness.get(), new_frame(info, 9, 0, planes));
    gst_harness_push_event(harness.get(), gst_event_new_flush_start());
    gst_harness_push_event(harness.get(), gst_event_new_flush_stop(TRUE));
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_harness_push_event(harness.get(), gst_event_new_segment(&segment));
    push_sweep(harness.get(), info, 2);
    const Owned<GstBuffer> stack(gst_harness_try_pull(harness.get()));
    ASSERT_TRUE(stack);
    EXPECT_EQ(shades_of(info, stack.get(), planes), shades_of_sweep(2, planes));
    EXPECT_EQ(count_in(harness.get(), "lost"), 0u);
}

TEST(MuxStream, the_segment_comes_again_after_a_flush)
{
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    segment.start = 5 * GST_SECOND;
    for (unsigned i = 0; i < 2; i++) {
        gst_harness_push_event(harness.get(), gst_event_new_flush_start());
        gst_harness_push_event(harness.get(), gst_event_new_flush_stop(TRUE));
        GstEvent *own = gst_event_new_segment(&segment);
        const guint32 seqnum = gst_event_get_seqnum(own);
        gst_harness_push_event(harness.get(), own);
        push_sweep(harness.get(), info, i);
        GstEvent *event = gst_pad_get_sticky_event(harness->sinkpad, GST_EVENT_SEGMENT, 0);
        ASSERT_NE(event, nullptr);
        const GstSegment *sent = nullptr;
        gst_event_parse_segment(event, &sent);
        EXPECT_EQ(sent->start, 5 * GST_SECOND);
        EXPECT_EQ(gst_event_get_seqnum(event), seqnum);
        gst_event_unref(event);
    }
}

TEST(MuxStream, gaps_do_not_stall)
{
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    gst_harness_push_event(harness.get(), gst_event_new_gap(0, frame_duration));
    push_sweep(harness.get(), info, 0);
    gst_harness_push_event(harness.get(), gst_event_new_gap(GST_SECOND, frame_duration));
    push_sweep(harness.get(), info, 1);
    EXPECT_EQ(gst_harness_buffers_received(harness.get()), 2u);
    bool seen = false;
    while (GstEvent *event = gst_harness_try_pull_event(harness.get())) {
        seen |= GST_EVENT_TYPE(event) == GST_EVENT_GAP;
        gst_event_unref(event);
    }
    EXPECT_TRUE(seen);
}

TEST(MuxStream, the_cameras_clock_goes_along)
{
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    g_autoptr(GstCaps) clock = gst_caps_new_empty_simple("timestamp/x-camera");
    for (unsigned z = 0; z < planes; z++) {
        GstBuffer *frame = new_frame(info, 0, z, planes);
        gst_buffer_add_reference_timestamp_meta(frame, clock, 1000 + z, GST_CLOCK_TIME_NONE);
        gst_harness_push(harness.get(), frame);
    }
    const Owned<GstBuffer> stack(gst_harness_try_pull(harness.get()));
    ASSERT_TRUE(stack);
    const GstReferenceTimestampMeta *time = gst_buffer_get_reference_timestamp_meta(stack.get(), clock);
    ASSERT_NE(time, nullptr);
    EXPECT_EQ(time->timestamp, 1000u);
}

TEST(MuxStream, frames_without_times_are_timed_by_the_rate)
{
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    for (uint64_t sweep = 0; sweep < 2; sweep++)
        for (unsigned z = 0; z < planes; z++) {
            GstBuffer *frame = new_frame(info, sweep, z, planes);
            GST_BUFFER_PTS(frame) = GST_CLOCK_TIME_NONE;
            GST_BUFFER_DURATION(frame) = GST_CLOCK_TIME_NONE;
            gst_harness_push(harness.get(), frame);
        }
    Owned<GstBuffer>(gst_harness_try_pull(harness.get()));
    const Owned<GstBuffer> second(gst_harness_try_pull(harness.get()));
    ASSERT_TRUE(second);
    EXPECT_EQ(GST_BUFFER_PTS(second.get()), GST_SECOND / 40);
    EXPECT_EQ(GST_BUFFER_DURATION(second.get()), GST_SECOND / 40);
}

TEST(MuxStream, latency_is_that_of_the_planes_to_come)
{
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const auto latency_of = [&](const char *settings) {
        const auto harness = new_mux(settings);
        gst_harness_set_upstream_latency(harness.get(), 10 * GST_MSECOND);
        gst_harness_set_src_caps_str(harness.get(),
                                     "video/x-raw,format=GRAY8,width=32,height=16,framerate=100/1");
        push_sweep(harness.get(), info, 0);
        return gst_harness_query_latency(harness.get());
    };
    EXPECT_EQ(latency_of("focalstackmux"), 30 * GST_MSECOND);
    EXPECT_EQ(latency_of("focalstackmux window=rolling"), 30 * GST_MSECOND);
    EXPECT_EQ(latency_of("focalstackmux on-missing=repeat"), 60 * GST_MSECOND);
}

TEST(MuxStream, stacks_outlive_the_mux)
{
    const GstVideoInfo info = video_info("GRAY8", 640, 480);
    auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 640, 480).c_str());
    push_sweep(harness.get(), info, 3);
    const Owned<GstBuffer> stack(gst_harness_try_pull(harness.get()));
    harness.reset();
    EXPECT_EQ(shades_of(info, stack.get(), planes), shades_of_sweep(3, planes));
}

TEST(MuxStream, a_hundred_stacks_may_wait_downstream)
{
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    for (uint64_t sweep = 0; sweep < 100; sweep++)
        push_sweep(harness.get(), info, sweep);
    EXPECT_EQ(gst_harness_buffers_in_queue(harness.get()), 100u);
    for (uint64_t sweep = 0; sweep < 100; sweep++) {
        const Owned<GstBuffer> stack(gst_harness_try_pull(harness.get()));
        ASSERT_EQ(shades_of(info, stack.get(), planes), shades_of_sweep(sweep, planes));
    }
}

TEST(MuxStream, frames_without_times_are_timed_anew_after_a_flush)
{
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    for (unsigned pass = 0; pass < 2; pass++) {
        GstSegment bytes;
        gst_segment_init(&bytes, GST_FORMAT_BYTES);
        gst_harness_push_event(harness.get(), gst_event_new_segment(&bytes));
        for (uint64_t sweep = 0; sweep < 3; sweep++)
            for (unsigned z = 0; z < planes; z++) {
                GstBuffer *frame = new_frame(info, sweep, z, planes);
                GST_BUFFER_PTS(frame) = GST_BUFFER_DURATION(frame) = GST_CLOCK_TIME_NONE;
                gst_harness_push(harness.get(), frame);
            }
        for (unsigned k = 0; k < 3; k++) {
            const Owned<GstBuffer> stack(gst_harness_try_pull(harness.get()));
            ASSERT_TRUE(stack);
            EXPECT_EQ(GST_BUFFER_PTS(stack.get()), gst_util_uint64_scale(k, planes * GST_SECOND, 120))
                << "pass " << pass;
        }
        gst_harness_push_event(harness.get(), gst_event_new_flush_start());
        gst_harness_push_event(harness.get(), gst_event_new_flush_stop(TRUE));
    }
}

TEST(MuxStream, a_converter_before_the_mux_is_told_what_stacks_are_wanted)
{
    const auto harness = new_mux("focalstackmux ! capsfilter caps=video/x-focal-stack,format=NV12,width=64");
    g_autoptr(GstCaps) allowed = gst_pad_peer_query_caps(harness->srcpad, nullptr);
    g_autoptr(GstCaps) wanted = gst_caps_from_string("video/x-raw,format=NV12,width=64,height=[1,16384],"
                                                     "framerate=[0/1,2147483647/1]");
    EXPECT_TRUE(gst_caps_is_equal(allowed, wanted));
}

/* Aggregators number their end by the segment. */
TEST(MuxStream, a_stream_without_a_stack_has_a_segment_before_its_end)
{
    const auto harness = new_mux("focalstackmux");
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    gst_harness_push_event(harness.get(), gst_event_new_eos());
    EXPECT_EQ(events_of(harness.get()),
              (std::vector{GST_EVENT_STREAM_START, GST_EVENT_SEGMENT, GST_EVENT_EOS}));
}

/* The segment before the end came without caps: caps must not come behind it. */
TEST(MuxStream, a_stream_without_a_stack_may_be_followed_by_one_with_stacks)
{
    const Complaints complaints;
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const auto harness = new_mux();
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    gst_harness_push_event(harness.get(), gst_event_new_eos());
    events_of(harness.get());

    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_harness_push_event(harness.get(), gst_event_new_stream_start("anew"));
    g_autoptr(GstCaps) caps = gst_caps_from_string(frame_caps("GRAY8", 32, 16).c_str());
    gst_harness_push_event(harness.get(), gst_event_new_caps(caps));
    gst_harness_push_event(harness.get(), gst_event_new_segment(&segment));
    push_sweep(harness.get(), info, 0);
    EXPECT_EQ(gst_harness_buffers_in_queue(harness.get()), 1u);
    EXPECT_EQ(events_of(harness.get()),
              (std::vector{GST_EVENT_FLUSH_START, GST_EVENT_FLUSH_STOP, GST_EVENT_STREAM_START,
                           GST_EVENT_CAPS, GST_EVENT_SEGMENT}));
}
