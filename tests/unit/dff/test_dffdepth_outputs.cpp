/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "../common/complaints.h"
#include "test_pipeline.h"

#include <algorithm>
#include <gst/check/gstharness.h>
#include <gtest/gtest.h>

using dff::run;
using dff::TestPipeline;

namespace {

const std::string sweep =
    "lenssweeptestsrc num-buffers=30 ! video/x-raw,width=128,height=96 ! focalstackmux ! dffdepth name=d ";

} // namespace

TEST(DffDepthOutputs, every_map_has_a_picture_a_stack)
{
    TestPipeline pipeline(sweep + "! queue ! appsink name=depth sync=false "
                                  "d.sparse ! queue ! appsink name=sparse sync=false "
                                  "d.confidence ! queue ! appsink name=confidence sync=false "
                                  "d.motion ! queue ! appsink name=motion sync=false "
                                  "d.uncertainty ! queue ! appsink name=uncertainty sync=false");
    pipeline.play();
    for (const char *sink : {"depth", "sparse", "confidence", "motion", "uncertainty"}) {
        const std::vector<GstSample *> samples = pipeline.pull_all(sink);
        EXPECT_EQ(samples.size(), 5u) << sink;
        for (GstSample *sample : samples) {
            const GstStructure *caps = gst_caps_get_structure(gst_sample_get_caps(sample), 0);
            const bool is_depth =
                g_str_equal(sink, "depth") || g_str_equal(sink, "sparse") || g_str_equal(sink, "uncertainty");
            EXPECT_STREQ(gst_structure_get_string(caps, "format"), is_depth ? "GRAY16_LE" : "GRAY8");
            EXPECT_EQ(gst_buffer_get_depth_meta(gst_sample_get_buffer(sample)) != nullptr, is_depth);
            gst_sample_unref(sample);
        }
    }
}

TEST(DffDepthOutputs, sparse_has_holes_and_the_dense_map_has_none)
{
    TestPipeline pipeline(
        sweep + "! queue ! appsink name=depth sync=false d.sparse ! queue ! appsink name=sparse sync=false");
    pipeline.play();
    const auto zeros = [&](const char *sink) {
        g_autoptr(GstSample) sample = pipeline.pull(sink);
        GstMapInfo map;
        gst_buffer_map(gst_sample_get_buffer(sample), &map, GST_MAP_READ);
        size_t count = 0;
        for (size_t i = 0; i < map.size; i += 2)
            count += map.data[i] == 0 && map.data[i + 1] == 0;
        gst_buffer_unmap(gst_sample_get_buffer(sample), &map);
        return count;
    };
    EXPECT_EQ(zeros("depth"), 0u);
    const size_t unknown = zeros("sparse");
    EXPECT_GT(unknown, 128u * 96 / 10);
    EXPECT_LT(unknown, 128u * 96);
}

namespace {

/* Median of a map's pixels over the first stack. */
unsigned median_of(TestPipeline &pipeline, const char *sink, GstDepthInfo *facts)
{
    g_autoptr(GstSample) sample = pipeline.pull(sink);
    GstBuffer *buffer = gst_sample_get_buffer(sample);
    gst_depth_meta_get_depth(gst_buffer_get_depth_meta(buffer), facts);
    GstMapInfo map;
    gst_buffer_map(buffer, &map, GST_MAP_READ);
    std::vector<unsigned> pixels;
    for (size_t i = 0; i + 1 < map.size; i += 2)
        pixels.push_back(map.data[i] + 256u * map.data[i + 1]);
    gst_buffer_unmap(buffer, &map);
    std::nth_element(pixels.begin(), pixels.begin() + static_cast<std::ptrdiff_t>(pixels.size() / 2),
                     pixels.end());
    return pixels[pixels.size() / 2];
}

} // namespace

TEST(DffDepthOutputs, uncertainty_is_in_the_unit_of_depth_and_grows_with_noise)
{
    double last = 0.0;
    for (const char *noise : {"none", "strong"}) {
        double planes[2] = {};
        for (const char *unit : {"index", "millimetre"}) {
            TestPipeline pipeline(
                "lenssweeptestsrc num-buffers=6 scene=slant near=3 far=1 noise=" + std::string(noise) +
                " ! video/x-raw,width=128,height=96 ! focalstackmux ! dffdepth name=d unit=" + unit +
                " ! queue ! appsink name=depth sync=false "
                "d.uncertainty ! queue ! appsink name=uncertainty sync=false");
            pipeline.play();
            GstDepthInfo facts;
            const double deviation = median_of(pipeline, "uncertainty", &facts) * facts.scale;
            EXPECT_EQ(facts.offset, 0.0);
            /* In the middle of the slant, at 2 dioptres, a plane of 0.4 is 100 mm. */
            planes[g_str_equal(unit, "index") ? 0 : 1] =
                g_str_equal(unit, "index") ? deviation : deviation / 100.0;
        }
        EXPECT_GT(planes[0], last);
        EXPECT_LT(planes[0], 1.0);
        EXPECT_NEAR(planes[1], planes[0], 0.3 * planes[0] + 0.02);
        last = planes[0];
    }
}

TEST(DffDepthOutputs, a_method_that_tells_no_uncertainty_says_so_and_gives_zeros)
{
    TestPipeline pipeline(
        "lenssweeptestsrc num-buffers=6 ! video/x-raw,width=128,height=96 ! focalstackmux ! "
        "dffdepth name=d method=paper ! queue ! appsink name=depth sync=false "
        "d.uncertainty ! queue ! appsink name=uncertainty sync=false");
    pipeline.play();
    GstDepthInfo facts;
    EXPECT_EQ(median_of(pipeline, "uncertainty", &facts), 0u);
    EXPECT_GT(median_of(pipeline, "depth", &facts), 0u);
}

TEST(DffDepthOutputs, a_request_pad_that_is_not_linked_does_no_harm)
{
    TestPipeline pipeline(sweep + "! appsink name=depth sync=false");
    GstPad *pad = gst_element_request_pad_simple(pipeline.element("d"), "confidence");
    ASSERT_NE(pad, nullptr);
    pipeline.play();
    const std::vector<GstSample *> samples = pipeline.pull_all("depth");
    EXPECT_EQ(samples.size(), 5u);
    for (GstSample *sample : samples)
        gst_sample_unref(sample);
    gst_element_release_request_pad(pipeline.element("d"), pad);
    gst_object_unref(pad);
}

TEST(DffDepthOutputs, a_request_pad_can_come_and_go_while_it_runs)
{
    TestPipeline pipeline("lenssweeptestsrc num-buffers=240 ! video/x-raw,width=96,height=64 ! focalstackmux "
                          "! dffdepth name=d ! appsink name=depth sync=false max-buffers=2 "
                          "queue name=q ! fakesink name=extra async=false sync=false");
    pipeline.play();
    gst_sample_unref(pipeline.pull("depth"));
    for (int i = 0; i < 5; i++) {
        GstPad *pad = gst_element_request_pad_simple(pipeline.element("d"), "motion");
        g_autoptr(GstPad) peer = gst_element_get_static_pad(pipeline.element("q"), "sink");
        ASSERT_EQ(gst_pad_link(pad, peer), GST_PAD_LINK_OK);
        for (int stack = 0; stack < 3; stack++)
            gst_sample_unref(pipeline.pull("depth"));
        gst_pad_unlink(pad, peer);
        gst_element_release_request_pad(pipeline.element("d"), pad);
        gst_object_unref(pad);
    }
    const std::vector<GstSample *> rest = pipeline.pull_all("depth");
    EXPECT_EQ(rest.size(), 40u - 1 - 15);
    for (GstSample *sample : rest)
        gst_sample_unref(sample);
}

TEST(DffDepthOutputs, one_more_of_the_same_pad_is_refused)
{
    TestPipeline pipeline(sweep + "! fakesink");
    GstPad *pad = gst_element_request_pad_simple(pipeline.element("d"), "sparse");
    EXPECT_EQ(gst_element_request_pad_simple(pipeline.element("d"), "sparse"), nullptr);
    gst_element_release_request_pad(pipeline.element("d"), pad);
    gst_object_unref(pad);
}

TEST(DffDepthOutputs, only_the_confidence_linked_is_enough)
{
    EXPECT_TRUE(run("lenssweeptestsrc num-buffers=12 ! focalstackmux ! dffdepth name=d d.confidence ! queue "
                    "! fakesink")
                    .end_of_stream);
}

TEST(DffDepthOutputs, nothing_linked_says_so)
{
    EXPECT_FALSE(run("lenssweeptestsrc num-buffers=12 ! focalstackmux ! dffdepth").error.empty());
}

namespace {

constexpr const char *two_planes = "video/x-focal-stack,format=GRAY8,width=64,height=64,planes=2,"
                                   "framerate=26/1";

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

/* Aggregators number their end by the segment. */
TEST(DffDepthOutputs, a_stream_without_a_stack_has_a_segment_before_its_end)
{
    gst_init(nullptr, nullptr);
    GstHarness *harness = gst_harness_new("dffdepth");
    gst_harness_set_src_caps_str(harness, two_planes);
    gst_harness_push_event(harness, gst_event_new_eos());
    EXPECT_EQ(events_of(harness), (std::vector{GST_EVENT_STREAM_START, GST_EVENT_SEGMENT, GST_EVENT_EOS}));
    gst_harness_teardown(harness);
}

/* The segment before the end came without caps: caps must not come behind it. */
TEST(DffDepthOutputs, a_stream_without_a_stack_may_be_followed_by_one_with_stacks)
{
    gst_init(nullptr, nullptr);
    const Complaints complaints;
    GstHarness *harness = gst_harness_new("dffdepth");
    gst_harness_set_src_caps_str(harness, two_planes);
    gst_harness_push_event(harness, gst_event_new_eos());
    events_of(harness);

    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    g_autoptr(GstCaps) caps = gst_caps_from_string(two_planes);
    gst_harness_push_event(harness, gst_event_new_stream_start("anew"));
    gst_harness_push_event(harness, gst_event_new_caps(caps));
    gst_harness_push_event(harness, gst_event_new_segment(&segment));
    EXPECT_EQ(gst_harness_push(harness, gst_harness_create_buffer(harness, 2 * 64 * 64)), GST_FLOW_OK);
    EXPECT_EQ(gst_harness_buffers_in_queue(harness), 1u);
    EXPECT_EQ(events_of(harness), (std::vector{GST_EVENT_FLUSH_START, GST_EVENT_FLUSH_STOP,
                                               GST_EVENT_STREAM_START, GST_EVENT_CAPS, GST_EVENT_SEGMENT}));
    gst_harness_teardown(harness);
}
