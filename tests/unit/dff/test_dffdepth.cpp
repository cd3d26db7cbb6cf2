/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_pipeline.h"

#include <gst/check/gstharness.h>
#include <gst/video/video.h>
#include <gtest/gtest.h>

using dff::gray_stack;
using dff::Outcome;
using dff::run;
using dff::TestPipeline;
using dff::write_file;

namespace {

std::string source(const std::string &file, const std::string &caps, unsigned buffers = 1)
{
    return "multifilesrc location=" + file + " num-buffers=" + std::to_string(buffers) +
           " caps=\"video/x-focal-stack," + caps + "\"";
}

guint16 centre_pixel(GstSample *sample)
{
    GstVideoInfo info;
    GstVideoFrame frame;
    gst_video_info_from_caps(&info, gst_sample_get_caps(sample));
    gst_video_frame_map(&frame, &info, gst_sample_get_buffer(sample), GST_MAP_READ);
    const auto *row = static_cast<const guint8 *>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0)) +
                      GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0) * (GST_VIDEO_FRAME_HEIGHT(&frame) / 2);
    const guint16 pixel = GST_READ_UINT16_LE(row + GST_VIDEO_FRAME_WIDTH(&frame) / 2 * 2);
    gst_video_frame_unmap(&frame);
    return pixel;
}

} // namespace

TEST(DffDepth, a_stack_without_any_meta_gives_depth_in_planes)
{
    const std::string file = write_file("stack", gray_stack(101, 75, 5, 3));
    TestPipeline pipeline(source(file, "format=GRAY8,width=101,height=75,planes=5,framerate=26/1", 3) +
                          " ! dffdepth unit=index ! appsink name=out sync=false");
    pipeline.play();
    const std::vector<GstSample *> samples = pipeline.pull_all("out");
    ASSERT_EQ(samples.size(), 3u);
    for (size_t k = 0; k < samples.size(); k++) {
        GstBuffer *buffer = gst_sample_get_buffer(samples[k]);
        const GstDepthMeta *meta = gst_buffer_get_depth_meta(buffer);
        ASSERT_NE(meta, nullptr);
        EXPECT_EQ(meta->unit, GST_DEPTH_UNIT_INDEX);
        EXPECT_EQ(meta->sequence, k);
        EXPECT_NEAR(meta->offset + meta->scale * centre_pixel(samples[k]), 3.0, 0.01);
        EXPECT_EQ(GST_BUFFER_PTS(buffer), gst_util_uint64_scale(k, GST_SECOND, 26));
        EXPECT_EQ(gst_sample_get_segment(samples[k])->format, GST_FORMAT_TIME);
        const GstStructure *caps = gst_caps_get_structure(gst_sample_get_caps(samples[k]), 0);
        EXPECT_STREQ(gst_structure_get_string(caps, "depth-unit"), "index");
        gst_sample_unref(samples[k]);
    }
}

TEST(DffDepth, swept_planes_give_depth_in_dioptres)
{
    TestPipeline pipeline("lenssweeptestsrc num-buffers=12 near=4 far=1 ! video/x-raw,width=160,height=120 "
                          "! focalstackmux ! dffdepth ! appsink name=out sync=false");
    pipeline.play();
    const std::vector<GstSample *> samples = pipeline.pull_all("out");
    ASSERT_EQ(samples.size(), 2u);
    for (GstSample *sample : samples) {
        const GstDepthMeta *meta = gst_buffer_get_depth_meta(gst_sample_get_buffer(sample));
        EXPECT_EQ(meta->unit, GST_DEPTH_UNIT_DIOPTRE);
        EXPECT_DOUBLE_EQ(meta->near, 4.0);
        EXPECT_DOUBLE_EQ(meta->far, 1.0);
        EXPECT_NEAR(meta->offset + meta->scale * 1, 4.0, 1e-9);
        EXPECT_NEAR(meta->offset + meta->scale * 65535, 1.0, 1e-9);
        gst_sample_unref(sample);
    }
}

TEST(DffDepth, every_stack_gives_one_depth_even_where_nothing_can_be_told)
{
    std::vector<guint8> stacks;
    for (const unsigned sharp : {1u, 2u, 99u, 0u, 1u, 99u, 2u, 3u}) {
        const std::vector<guint8> stack = gray_stack(64, 64, 4, sharp);
        stacks.insert(stacks.end(), stack.begin(), stack.end());
    }
    const std::string file = write_file("stacks", stacks);
    TestPipeline pipeline(
        "filesrc location=" + file +
        " blocksize=16384 ! video/x-focal-stack,format=GRAY8,width=64,"
        "height=64,planes=4,framerate=10/1 ! dffdepth name=d ! appsink name=out sync=false");
    pipeline.play();
    const std::vector<GstSample *> samples = pipeline.pull_all("out");
    ASSERT_EQ(samples.size(), 8u);
    for (size_t k = 0; k < samples.size(); k++) {
        GstBuffer *buffer = gst_sample_get_buffer(samples[k]);
        const bool untold = k == 2 || k == 5;
        EXPECT_EQ(GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_GAP), untold) << k;
        EXPECT_EQ(GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_CORRUPTED), untold) << k;
        EXPECT_EQ(centre_pixel(samples[k]) == 0, untold) << k;
        gst_sample_unref(samples[k]);
    }
    g_autoptr(GstStructure) stats = nullptr;
    g_object_get(pipeline.element("d"), "stats", &stats, nullptr);
    guint64 count = 0, without = 0;
    gst_structure_get(stats, "stacks", G_TYPE_UINT64, &count, "without-depth", G_TYPE_UINT64, &without,
                      nullptr);
    EXPECT_EQ(count, 8u);
    EXPECT_EQ(without, 2u);
}

TEST(DffDepth, a_stack_that_does_not_fit_its_caps_is_an_error_that_names_both_sizes)
{
    std::vector<guint8> stack = gray_stack(64, 64, 4, 1);
    stack.resize(stack.size() - 100);
    const Outcome outcome =
        run(source(write_file("short", stack), "format=GRAY8,width=64,height=64,planes=4,framerate=1/1") +
            " ! dffdepth ! fakesink");
    EXPECT_NE(outcome.error.find("16284"), std::string::npos) << outcome.error;
    EXPECT_NE(outcome.error.find("16384"), std::string::npos) << outcome.error;
}

TEST(DffDepth, one_plane_is_no_stack)
{
    const Outcome outcome = run(source(write_file("one", gray_stack(64, 64, 1, 0)),
                                       "format=GRAY8,width=64,height=64,planes=1,framerate=1/1") +
                                " ! dffdepth ! fakesink");
    EXPECT_FALSE(outcome.error.empty());
    EXPECT_FALSE(outcome.end_of_stream);
}

TEST(DffDepth, a_unit_that_cannot_be_had_is_an_error_that_says_what_to_do)
{
    const std::string file = write_file("unit", gray_stack(64, 64, 3, 1));
    const std::string caps = "format=GRAY8,width=64,height=64,planes=3,framerate=1/1";
    EXPECT_NE(run(source(file, caps) + " ! dffdepth unit=millimetre ! fakesink").error.find("lenssweeptag"),
              std::string::npos);
    EXPECT_NE(run(source(file, caps) + " ! dffdepth unit=micrometre ! fakesink").error.find("unit=index"),
              std::string::npos);
}

TEST(DffDepth, an_unknown_device_is_an_error_that_lists_the_devices)
{
    const Outcome outcome =
        run("lenssweeptestsrc num-buffers=6 ! focalstackmux ! dffdepth device=nonsense ! fakesink");
    EXPECT_NE(outcome.error.find("nonsense"), std::string::npos) << outcome.error;
    EXPECT_NE(outcome.error.find("There are:"), std::string::npos) << outcome.error;
}

TEST(DffDepth, properties_change_while_it_runs)
{
    TestPipeline pipeline("lenssweeptestsrc num-buffers=60 ! video/x-raw,width=96,height=64 ! focalstackmux "
                          "! dffdepth name=d ! appsink name=out sync=false max-buffers=1");
    pipeline.play();
    guint stacks = 0;
    while (GstSample *sample = pipeline.pull("out")) {
        g_object_set(pipeline.element("d"), "sigma-xy", 8 + stacks, "levels", 1 + stacks % 4, "iterations",
                     stacks, nullptr);
        gst_sample_unref(sample);
        stacks++;
    }
    EXPECT_EQ(stacks, 10u);
}

TEST(DffDepth, values_out_of_range_keep_the_old_value)
{
    gst_init(nullptr, nullptr);
    g_autoptr(GstElement) element =
        GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make("dffdepth", nullptr)));
    guint levels = 0;
    g_object_set(element, "levels", 9, nullptr);
    g_object_get(element, "levels", &levels, nullptr);
    EXPECT_LE(levels, 4u);
    const Outcome outcome =
        run("lenssweeptestsrc num-buffers=6 ! focalstackmux ! dffdepth levels=nine ! fakesink");
    EXPECT_FALSE(outcome.error.empty());
}

TEST(DffDepth, the_stream_of_another_size_goes_on)
{
    const std::string small = write_file("small", gray_stack(64, 64, 3, 1));
    const std::string large = write_file("large", gray_stack(128, 80, 5, 4));
    TestPipeline pipeline("concat name=c ! dffdepth unit=index ! appsink name=out sync=false " +
                          source(small, "format=GRAY8,width=64,height=64,planes=3,framerate=5/1") + " ! c. " +
                          source(large, "format=GRAY8,width=128,height=80,planes=5,framerate=5/1") + " ! c.");
    pipeline.play();
    const std::vector<GstSample *> samples = pipeline.pull_all("out");
    ASSERT_EQ(samples.size(), 2u);
    gint width = 0;
    gst_structure_get_int(gst_caps_get_structure(gst_sample_get_caps(samples[1]), 0), "width", &width);
    EXPECT_EQ(width, 128);
    EXPECT_NEAR(centre_pixel(samples[0]), 1 + 65534 / 2, 200);
    EXPECT_EQ(centre_pixel(samples[1]), 65535);
    for (GstSample *sample : samples)
        gst_sample_unref(sample);
}

TEST(DffDepth, live_latency_holds_the_computing)
{
    TestPipeline pipeline(
        "lenssweeptestsrc is-live=true num-buffers=60 ! video/x-raw,width=640,height=480 ! focalstackmux "
        "! dffdepth name=d ! appsink name=out");
    pipeline.play();
    for (int k = 0; k < 2; k++) /* the first may wait for the compiler */
        gst_sample_unref(pipeline.pull("out"));
    g_autoptr(GstPad) source_pad = gst_element_get_static_pad(pipeline.element("d"), "src");
    g_autoptr(GstPad) sink_pad = gst_element_get_static_pad(pipeline.element("d"), "sink");
    GstClockTime before = 0, after = 0;
    g_autoptr(GstQuery) query = gst_query_new_latency();
    ASSERT_TRUE(gst_pad_query(source_pad, query));
    gst_query_parse_latency(query, nullptr, &after, nullptr);
    ASSERT_TRUE(gst_pad_peer_query(sink_pad, query));
    gst_query_parse_latency(query, nullptr, &before, nullptr);
    EXPECT_GT(after, before);
}

TEST(DffDepth, a_gap_comes_after_caps_and_in_its_own_segment)
{
    gst_init(nullptr, nullptr);
    GstHarness *harness = gst_harness_new("dffdepth");
    gst_harness_set_src_caps_str(
        harness, "video/x-focal-stack,format=GRAY8,width=64,height=64,planes=3,framerate=5/1");
    gst_harness_push_event(harness, gst_event_new_gap(0, GST_SECOND));
    const std::vector<guint8> stack = gray_stack(64, 64, 3, 1);
    gst_harness_push(harness, gst_buffer_new_memdup(stack.data(), stack.size()));

    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    segment.base = GST_SECOND;
    GstEvent *event = gst_event_new_segment(&segment);
    const guint32 seqnum = gst_event_get_seqnum(event);
    gst_harness_push_event(harness, event);
    gst_harness_push_event(harness, gst_event_new_gap(0, GST_SECOND));

    std::vector<GstEventType> events;
    guint32 last_segment = 0;
    while (g_autoptr(GstEvent) sent = gst_harness_try_pull_event(harness)) {
        events.push_back(GST_EVENT_TYPE(sent));
        if (GST_EVENT_TYPE(sent) == GST_EVENT_SEGMENT)
            last_segment = gst_event_get_seqnum(sent);
    }
    EXPECT_EQ(events, (std::vector{GST_EVENT_STREAM_START, GST_EVENT_CAPS, GST_EVENT_SEGMENT,
                                   GST_EVENT_SEGMENT, GST_EVENT_GAP}));
    EXPECT_EQ(last_segment, seqnum);
    gst_harness_teardown(harness);
}
