/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "support.h"

#include <cstdio>
#include <fstream>
#include <gst/app/gstappsink.h>
#include <gst/app/gstappsrc.h>
#include <gtest/gtest.h>
#include <stdexcept>

namespace {

constexpr unsigned planes = 4;

/* A pipeline with an appsrc "in" that gets tagged frames and an appsink "out". */
class Pipeline {
public:
    explicit Pipeline(const std::string &description)
    {
        g_autoptr(GError) error = nullptr;
        pipeline_ = gst_parse_launch(description.c_str(), &error);
        if (error)
            throw std::runtime_error(error->message);
        in_ = gst_bin_get_by_name(GST_BIN(pipeline_), "in");
        out_ = gst_bin_get_by_name(GST_BIN(pipeline_), "out");
        gst_element_set_state(pipeline_, GST_STATE_PLAYING);
    }

    ~Pipeline()
    {
        gst_element_set_state(pipeline_, GST_STATE_NULL);
        gst_object_unref(pipeline_);
        if (in_)
            gst_object_unref(in_);
        if (out_)
            gst_object_unref(out_);
    }

    Pipeline(const Pipeline &) = delete;
    Pipeline &operator=(const Pipeline &) = delete;

    void push(GstBuffer *frame) { EXPECT_EQ(gst_app_src_push_buffer(GST_APP_SRC(in_), frame), GST_FLOW_OK); }
    void end() { gst_app_src_end_of_stream(GST_APP_SRC(in_)); }

    GstSample *pull() { return gst_app_sink_try_pull_sample(GST_APP_SINK(out_), 10 * GST_SECOND); }

    /* An empty text if the stream came to its end. */
    std::string wait_for_end()
    {
        GstBus *bus = gst_element_get_bus(pipeline_);
        const Owned<GstMessage> message(gst_bus_timed_pop_filtered(
            bus, 60 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS)));
        gst_object_unref(bus);
        if (!message)
            return "neither end nor error";
        if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_EOS)
            return "";
        g_autoptr(GError) error = nullptr;
        gst_message_parse_error(message.get(), &error, nullptr);
        return error->message;
    }

    GstElement *bin() { return pipeline_; }

private:
    GstElement *pipeline_;
    GstElement *in_;
    GstElement *out_;
};

std::string source(const char *format, int width, int height)
{
    return "appsrc name=in format=time max-buffers=8 block=true caps=" + frame_caps(format, width, height) +
           " ! ";
}

struct SampleUnref {
    void operator()(GstSample *sample) const { gst_sample_unref(sample); }
};
using OwnedSample = std::unique_ptr<GstSample, SampleUnref>;

long resident_kilobytes()
{
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmRSS:"))
            return std::stol(line.substr(6));
    return 0;
}

} // namespace

TEST(Pipelines, mux_then_demux_gives_the_frames_back)
{
    const GstVideoInfo info = video_info("NV12", 36, 18);
    Pipeline pipeline(source("NV12", 36, 18) +
                      "focalstackmux ! focalstackdemux ! appsink name=out sync=false");
    for (uint64_t sweep = 3; sweep < 5; sweep++)
        for (unsigned z = 0; z < planes; z++)
            pipeline.push(new_frame(info, sweep, z, planes));
    pipeline.end();
    for (uint64_t sweep = 3; sweep < 5; sweep++)
        for (unsigned z = 0; z < planes; z++) {
            const OwnedSample sample(pipeline.pull());
            ASSERT_TRUE(sample);
            GstVideoInfo found;
            ASSERT_TRUE(gst_video_info_from_caps(&found, gst_sample_get_caps(sample.get())));
            EXPECT_EQ(GST_VIDEO_INFO_FPS_N(&found), 120);
            GstBuffer *frame = gst_sample_get_buffer(sample.get());
            const Owned<GstBuffer> original(new_frame(info, sweep, z, planes));
            const uint64_t number = sweep * planes + z;
            GstMapInfo map;
            gst_buffer_map(frame, &map, GST_MAP_READ);
            EXPECT_EQ(gst_buffer_memcmp(original.get(), 0, map.data, map.size), 0);
            EXPECT_EQ(map.size, GST_VIDEO_INFO_SIZE(&info));
            gst_buffer_unmap(frame, &map);
            EXPECT_EQ(GST_BUFFER_PTS(frame), number * frame_duration);
            EXPECT_EQ(GST_BUFFER_DURATION(frame), frame_duration);
            const GstFocusMeta *focus = gst_buffer_get_focus_meta(frame);
            ASSERT_NE(focus, nullptr);
            EXPECT_EQ(focus->sweep, sweep);
            EXPECT_EQ(focus->plane, z);
            EXPECT_EQ(focus->frame_id, number);
            EXPECT_DOUBLE_EQ(focus->power, 5.0 - z);
        }
    EXPECT_EQ(pipeline.wait_for_end(), "");
}

TEST(Pipelines, metas_survive_videoconvert_and_videoscale)
{
    const GstVideoInfo info = video_info("RGB", 64, 48);
    Pipeline pipeline(
        source("RGB", 64, 48) +
        "videoconvert ! videoscale ! video/x-raw,format=I420,width=32,height=24 ! focalstackmux ! "
        "appsink name=out sync=false");
    for (unsigned z = 0; z < planes; z++)
        pipeline.push(new_frame(info, 0, z, planes));
    pipeline.end();
    const OwnedSample sample(pipeline.pull());
    ASSERT_TRUE(sample);
    GstFocalStackInfo stack;
    ASSERT_TRUE(gst_focal_stack_info_from_caps(&stack, gst_sample_get_caps(sample.get())));
    EXPECT_EQ(GST_VIDEO_INFO_FORMAT(&stack.frame), GST_VIDEO_FORMAT_I420);
    EXPECT_EQ(GST_VIDEO_INFO_WIDTH(&stack.frame), 32);
    EXPECT_TRUE(gst_buffer_get_focal_stack_meta(gst_sample_get_buffer(sample.get()))->complete);
}

TEST(Pipelines, one_source_a_plane)
{
    Pipeline pipeline("videotestsrc num-buffers=20 pattern=black ! video/x-raw,format=GRAY8 ! m.sink_0 "
                      "videotestsrc num-buffers=20 pattern=white ! video/x-raw,format=GRAY8 ! m.sink_1 "
                      "videotestsrc num-buffers=20 pattern=red ! video/x-raw,format=GRAY8 ! queue ! m.sink_2 "
                      "focalstackmux name=m ! appsink name=out sync=false");
    const GstVideoInfo info = video_info("GRAY8", 320, 240);
    for (uint64_t k = 0; k < 20; k++) {
        const OwnedSample sample(pipeline.pull());
        ASSERT_TRUE(sample);
        GstBuffer *stack = gst_sample_get_buffer(sample.get());
        const auto shades = shades_of(info, stack, 3);
        EXPECT_TRUE(gst_buffer_get_focal_stack_meta(stack)->complete) << k;
        EXPECT_LT(shades[0], shades[2]);
        EXPECT_LT(shades[2], shades[1]);
        EXPECT_EQ(GST_BUFFER_PTS(stack), gst_util_uint64_scale(k, GST_SECOND, 30));
    }
    EXPECT_EQ(pipeline.wait_for_end(), "");
}

TEST(Pipelines, one_source_a_plane_goes_on_after_every_seek)
{
    std::string description = "focalstackmux name=m ! appsink name=out sync=false max-buffers=2 ";
    for (const char *pad : {"sink_0", "sink_1", "sink_2"})
        description +=
            "videotestsrc ! video/x-raw,format=GRAY8,width=16,height=16 ! m." + std::string(pad) + " ";
    Pipeline pipeline(description);
    for (unsigned i = 0; i < 20; i++) {
        const GstClockTime time = (i * 7 % 20) * GST_SECOND;
        const OwnedSample before(i % 4 != 0 ? pipeline.pull() : nullptr);
        ASSERT_TRUE(gst_element_seek_simple(pipeline.bin(), GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH,
                                            static_cast<gint64>(time)));
        for (unsigned k = 0; k < 3; k++) {
            const OwnedSample stack(pipeline.pull());
            ASSERT_TRUE(stack) << "seek " << i;
            EXPECT_NEAR(GST_BUFFER_PTS(gst_sample_get_buffer(stack.get())), k * 1e9 / 30, 2) << "seek " << i;
        }
    }
}

TEST(Pipelines, a_live_source_that_falls_silent_stops_nobody)
{
    Pipeline pipeline("videotestsrc is-live=true num-buffers=30 ! m.sink_0 "
                      "videotestsrc is-live=true num-buffers=30 ! identity drop-probability=0.5 ! m.sink_1 "
                      "focalstackmux name=m on-missing=repeat ! fakesink");
    EXPECT_EQ(pipeline.wait_for_end(), "");
}

TEST(Pipelines, one_source_a_plane_may_end_early)
{
    Pipeline pipeline("videotestsrc num-buffers=5 ! m.sink_0  videotestsrc num-buffers=50 ! m.sink_1 "
                      "focalstackmux name=m on-missing=drop ! fakesink");
    EXPECT_EQ(pipeline.wait_for_end(), "");
    GstElement *mux = gst_bin_get_by_name(GST_BIN(pipeline.bin()), "m");
    EXPECT_EQ(count_of(mux, "stacks"), 5u);
    EXPECT_EQ(count_of(mux, "lost"), 45u);
    gst_object_unref(mux);
}

TEST(Pipelines, a_source_may_be_taken_away_while_it_waits_for_the_others)
{
    Pipeline pipeline("videotestsrc name=fast ! m.sink_0 "
                      "videotestsrc is-live=false num-buffers=20 ! identity sleep-time=50000 ! m.sink_1 "
                      "focalstackmux name=m planes=2 ! fakesink");
    GstElement *mux = gst_bin_get_by_name(GST_BIN(pipeline.bin()), "m");
    GstElement *fast = gst_bin_get_by_name(GST_BIN(pipeline.bin()), "fast");
    GstPad *pad = gst_element_get_static_pad(mux, "sink_0");
    g_usleep(100000);
    gst_element_release_request_pad(mux, pad);
    gst_element_set_state(fast, GST_STATE_NULL);
    gst_bin_remove(GST_BIN(pipeline.bin()), fast);
    EXPECT_NE(pipeline.wait_for_end(), "neither end nor error");
    gst_object_unref(pad);
    gst_object_unref(fast);
    gst_object_unref(mux);
}

TEST(Pipelines, a_stack_kept_after_the_end_is_valid)
{
    const GstVideoInfo info = video_info("GRAY8", 640, 480);
    OwnedSample kept;
    {
        Pipeline pipeline(source("GRAY8", 640, 480) + "focalstackmux ! appsink name=out sync=false");
        for (unsigned z = 0; z < planes; z++)
            pipeline.push(new_frame(info, 6, z, planes));
        kept.reset(pipeline.pull());
    }
    ASSERT_TRUE(kept);
    EXPECT_EQ(shades_of(info, gst_sample_get_buffer(kept.get()), planes), shades_of_sweep(6, planes));
}

TEST(Pipelines, a_frame_kept_after_the_end_is_valid)
{
    const GstVideoInfo info = video_info("GRAY8", 640, 480);
    OwnedSample kept;
    {
        Pipeline pipeline(source("GRAY8", 640, 480) + "focalstackmux ! focalstackdemux ! "
                                                      "appsink name=out sync=false wait-on-eos=false");
        for (unsigned z = 0; z < planes; z++)
            pipeline.push(new_frame(info, 6, z, planes));
        kept.reset(pipeline.pull());
        for (uint64_t sweep = 7; sweep < 17; sweep++)
            for (unsigned z = 0; z < planes; z++)
                pipeline.push(new_frame(info, sweep, z, planes));
        pipeline.end();
        EXPECT_EQ(pipeline.wait_for_end(), "");
    }
    ASSERT_TRUE(kept);
    GstVideoFrame frame;
    ASSERT_TRUE(gst_video_frame_map(&frame, &info, gst_sample_get_buffer(kept.get()), GST_MAP_READ));
    EXPECT_EQ(*static_cast<uint8_t *>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0)), shade(6, 0));
    gst_video_frame_unmap(&frame);
}

TEST(Pipelines, ten_thousand_frames_take_no_more_memory_than_a_thousand)
{
    const GstVideoInfo info = video_info("GRAY8", 64, 64);
    for (const char *window : {"sweep", "rolling"}) {
        Pipeline pipeline(source("GRAY8", 64, 64) + "focalstackmux on-missing=repeat window=" + window +
                          " ! queue max-size-buffers=4 ! focalstackdemux ! fakesink sync=false");
        const auto run = [&](uint64_t first, uint64_t last) {
            for (uint64_t number = first; number < last; number++)
                if (number % 97 != 0)
                    pipeline.push(new_frame(info, number / planes, number % planes, planes));
        };
        run(0, 1000);
        const long start = resident_kilobytes();
        run(1000, 10000);
        const long end = resident_kilobytes();
        pipeline.end();
        EXPECT_EQ(pipeline.wait_for_end(), "");
        std::printf("window=%s: resident after 1,000 frames %ld kB, after 10,000 frames %ld kB\n", window,
                    start, end);
#ifndef __SANITIZE_ADDRESS__ /* which keeps what was freed for a while, and finds leaks itself */
        EXPECT_LT(end - start, 2048);
#endif
    }
}

TEST(Pipelines, two_hundred_starts_and_stops)
{
    GstElement *pipeline =
        gst_parse_launch("videotestsrc ! video/x-raw,width=32,height=16 ! m.sink_0 "
                         "videotestsrc ! video/x-raw,width=32,height=16 ! m.sink_1 "
                         "focalstackmux name=m ! queue ! focalstackdemux ! fakesink sync=false",
                         nullptr);
    for (unsigned cycle = 0; cycle < 200; cycle++) {
        gst_element_set_state(pipeline, GST_STATE_PLAYING);
        if (cycle % 2) {
            ASSERT_EQ(gst_element_get_state(pipeline, nullptr, nullptr, 10 * GST_SECOND),
                      GST_STATE_CHANGE_SUCCESS);
        }
        ASSERT_EQ(gst_element_set_state(pipeline, GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
    }
    gst_object_unref(pipeline);
}
