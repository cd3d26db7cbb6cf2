/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fickle_filter.h"
#include "support.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <thread>
#include <unistd.h>

namespace {

const std::string small = " ! video/x-raw,width=64,height=48 ! ";

std::string error_of(const std::string &properties, const std::string &rest = small + "fakesink")
{
    return Pipeline("lenssweeptestsrc num-buffers=4 " + properties + rest).run();
}

int width_of(GstSample *sample)
{
    const GstVideoInfo info = info_of(sample);
    return GST_VIDEO_INFO_WIDTH(&info);
}

/* Files of 40 x 30 pixels that go with the test. */
class FilesScene : public testing::Test {
protected:
    FilesScene()
        : folder_(std::filesystem::temp_directory_path() / ("dff-testsrc-" + std::to_string(getpid())))
    {
        std::filesystem::create_directory(folder_);
        cv::Mat1b disparity(30, 40, uchar{30});
        disparity.colRange(20, 40) = 90;
        disparity.row(7) = 0;
        write("image.png", cv::Mat3b(30, 40, cv::Vec3b(10, 200, 90)));
        write("depth.png", disparity);
        write("small.png", disparity.rowRange(0, 29));
    }

    ~FilesScene() override { std::filesystem::remove_all(folder_); }

    void write(const char *name, const cv::Mat &picture) { cv::imwrite(folder_ / name, picture); }

    std::string files(const char *image, const char *depth) const
    {
        return "scene=files image=" + (folder_ / image).string() +
               " depth-map=" + (folder_ / depth).string() + " ";
    }

private:
    std::filesystem::path folder_;
};

} // namespace

TEST(TestSrcStream, num_buffers_ends_both_pads)
{
    Pipeline pipeline(
        "lenssweeptestsrc name=rig planes=4 num-buffers=10" + small +
        "queue ! appsink name=out sync=false rig.depth ! queue ! appsink name=depth sync=false");
    pipeline.set_state(GST_STATE_PLAYING);
    EXPECT_EQ(pipeline.pull_all("out").size(), 10U);
    EXPECT_EQ(pipeline.pull_all("depth").size(), 3U);
    EXPECT_EQ(pipeline.wait(), "");
}

TEST(TestSrcStream, no_frames_end_at_once)
{
    Pipeline pipeline("lenssweeptestsrc name=rig num-buffers=0" + small +
                      "queue ! fakesink rig.depth ! queue ! fakesink");
    EXPECT_EQ(pipeline.run(), "");
}

TEST(TestSrcStream, an_eos_from_the_application_ends_it)
{
    Pipeline pipeline("lenssweeptestsrc name=rig is-live=true rate=10" + small +
                      "queue ! fakesink rig.depth ! queue ! fakesink");
    pipeline.set_state(GST_STATE_PLAYING);
    g_usleep(200000);
    gst_element_send_event(pipeline.get(), gst_event_new_eos());
    EXPECT_EQ(pipeline.wait(), "");
}

TEST(TestSrcStream, the_depth_pad_alone_can_stay_unlinked)
{
    Pipeline pipeline("lenssweeptestsrc name=rig num-buffers=12" + small + "fakesink");
    GstPad *pad = gst_element_request_pad_simple(pipeline.element("rig"), "depth");
    ASSERT_NE(pad, nullptr);
    EXPECT_EQ(pipeline.run(), "");
    gst_element_release_request_pad(pipeline.element("rig"), pad);
    gst_object_unref(pad);
}

TEST(TestSrcStream, the_depth_pad_comes_and_goes_while_playing)
{
    Pipeline pipeline("lenssweeptestsrc name=rig is-live=true rate=50 planes=2" + small +
                      "queue ! fakesink sync=false");
    pipeline.set_state(GST_STATE_PLAYING);
    GstElement *rig = pipeline.element("rig");
    for (int i = 0; i < 5; i++) {
        GstPad *pad = gst_element_request_pad_simple(rig, "depth");
        GstElement *sink = gst_element_factory_make("appsink", nullptr);
        gst_bin_add(GST_BIN(pipeline.get()), sink);
        gst_element_sync_state_with_parent(sink);
        g_autoptr(GstPad) sink_pad = gst_element_get_static_pad(sink, "sink");
        gst_pad_link(pad, sink_pad);
        const Sample sample(gst_app_sink_try_pull_sample(GST_APP_SINK(sink), 5 * GST_SECOND));
        EXPECT_NE(sample, nullptr);
        gst_element_release_request_pad(rig, pad);
        gst_object_unref(pad);
        gst_element_set_locked_state(sink, TRUE);
        gst_element_set_state(sink, GST_STATE_NULL);
        gst_bin_remove(GST_BIN(pipeline.get()), sink);
    }
}

TEST(TestSrcStream, the_motion_pad_tells_how_each_pixel_moves)
{
    Pipeline pipeline("lenssweeptestsrc name=rig planes=4 num-buffers=10 pan=2.5" + small +
                      "queue ! fakesink rig.motion ! queue ! appsink name=motion sync=false");
    pipeline.set_state(GST_STATE_PLAYING);
    const auto samples = pipeline.pull_all("motion");
    ASSERT_EQ(samples.size(), 3U);
    EXPECT_EQ(GST_BUFFER_DURATION(gst_sample_get_buffer(samples[1].get())),
              gst_util_uint64_scale(GST_SECOND, 1, 26));
    const GstVideoInfo info = info_of(samples[1].get());
    EXPECT_EQ(GST_VIDEO_INFO_FORMAT(&info), GST_VIDEO_FORMAT_RGBA64_LE);
    const std::vector<uint8_t> bytes = bytes_of(samples[1].get());
    for (size_t pixel = 0; pixel < bytes.size(); pixel += 8) {
        EXPECT_NEAR(bytes[pixel] + 256 * bytes[pixel + 1], 32768 - 160, 1) << "to the left";
        EXPECT_EQ(bytes[pixel + 2] + 256 * bytes[pixel + 3], 32768);
    }
    EXPECT_EQ(pipeline.wait(), "");
}

TEST(TestSrcStream, a_cut_shows_the_scene_upside_down_from_the_very_frame_on)
{
    Pipeline pipeline("lenssweeptestsrc name=rig planes=4 num-buffers=12 cut=6 blur-step=0 ! "
                      "video/x-raw,format=GRAY8,width=64,height=48 ! queue ! appsink name=out sync=false "
                      "rig.depth ! queue ! appsink name=depth sync=false");
    pipeline.set_state(GST_STATE_PLAYING);
    const auto frames = pipeline.pull_all("out");
    ASSERT_EQ(frames.size(), 12U);
    EXPECT_EQ(bytes_of(frames[5].get()), bytes_of(frames[1].get()));
    std::vector<uint8_t> turned = bytes_of(frames[2].get());
    std::reverse(turned.begin(), turned.end());
    const std::vector<uint8_t> cut = bytes_of(frames[6].get());
    ASSERT_EQ(cut.size(), turned.size());
    for (size_t i = 0; i < cut.size(); i++)
        EXPECT_NEAR(cut[i], turned[i], 3);
    const auto depths = pipeline.pull_all("depth");
    ASSERT_EQ(depths.size(), 3U);
    EXPECT_EQ(depth_of(depths[0].get()), depth_of(depths[1].get())) << "as it is in the middle of the sweep";
    std::vector<uint16_t> expected = depth_of(depths[0].get());
    std::reverse(expected.begin(), expected.end());
    EXPECT_EQ(depth_of(depths[2].get()), expected);
}

TEST(TestSrcStream, a_scene_changes_with_the_next_sweep)
{
    Pipeline pipeline("lenssweeptestsrc name=rig planes=4" + small +
                      "appsink name=out sync=false max-buffers=1");
    pipeline.set_state(GST_STATE_PLAYING);
    const Sample before = pipeline.pull("out");
    g_object_set(pipeline.element("rig"), "seed", guint64{99}, nullptr);
    for (int i = 0; i < 12; i++) {
        const Sample sample = pipeline.pull("out");
        if (focus_of(sample)->plane == 0 && i >= 8) {
            EXPECT_NE(bytes_of(sample.get()), bytes_of(before.get()));
        }
    }
}

TEST(TestSrcStream, caps_can_change_while_playing)
{
    Pipeline pipeline(
        "lenssweeptestsrc planes=4 ! capsfilter name=caps caps=video/x-raw,width=64,height=48 ! "
        "appsink name=out sync=false max-buffers=1");
    pipeline.set_state(GST_STATE_PLAYING);
    pipeline.pull("out");
    g_autoptr(GstCaps) caps = gst_caps_from_string("video/x-raw,width=100,height=30");
    g_object_set(pipeline.element("caps"), "caps", caps, nullptr);
    Sample last;
    for (int i = 0; i < 12; i++)
        last = pipeline.pull("out");
    const GstVideoInfo info = info_of(last.get());
    EXPECT_EQ(GST_VIDEO_INFO_WIDTH(&info), 100);
    EXPECT_EQ(gst_buffer_get_size(gst_sample_get_buffer(last.get())), GST_VIDEO_INFO_SIZE(&info));
}

TEST(TestSrcStream, what_downstream_takes_may_change_while_caps_are_told)
{
    Pipeline pipeline(
        "lenssweeptestsrc planes=4 ! capsfilter name=caps caps=video/x-raw,width=64,height=48 ! "
        "appsink name=out sync=false max-buffers=1");
    const FickleFilter at_the_start(pipeline.element("caps"), 96);
    pipeline.set_state(GST_STATE_PLAYING);
    EXPECT_EQ(width_of(pipeline.pull("out").get()), 96);
    const FickleFilter in_mid_stream(pipeline.element("caps"), 32);
    g_autoptr(GstCaps) caps = gst_caps_from_string("video/x-raw,width=100,height=30");
    g_object_set(pipeline.element("caps"), "caps", caps, nullptr);
    int width = 96;
    for (int i = 0; i < 12 && width != 32; i++)
        width = width_of(pipeline.pull("out").get());
    EXPECT_EQ(width, 32);
}

TEST(TestSrcStream, a_live_frame_leaves_when_its_exposure_ends)
{
    Pipeline pipeline("lenssweeptestsrc is-live=true rate=20 planes=2 num-buffers=20" + small +
                      "appsink name=out sync=false");
    EXPECT_EQ(pipeline.set_state(GST_STATE_PAUSED), GST_STATE_CHANGE_NO_PREROLL);
    pipeline.set_state(GST_STATE_PLAYING);
    GstClockTime first = GST_CLOCK_TIME_NONE;
    for (int i = 0; i < 20; i++) {
        const Sample sample = pipeline.pull("out");
        ASSERT_NE(sample, nullptr);
        const GstBuffer *buffer = gst_sample_get_buffer(sample.get());
        const GstClockTime now = gst_element_get_current_running_time(pipeline.get());
        EXPECT_GE(now, GST_BUFFER_PTS(buffer) + GST_BUFFER_DURATION(buffer));
        if (first == GST_CLOCK_TIME_NONE)
            first = GST_BUFFER_PTS(buffer);
        EXPECT_EQ(GST_BUFFER_PTS(buffer), first + static_cast<guint>(i) * GST_SECOND / 40);
    }
    const GstClockTime end = gst_element_get_current_running_time(pipeline.get());
    EXPECT_LT(end, first + 20 * GST_SECOND / 40 + 2 * GST_SECOND);
}

TEST(TestSrcStream, live_latency_is_one_frame)
{
    Pipeline pipeline("lenssweeptestsrc is-live=true rate=20 planes=2" + small + "fakesink sync=true");
    pipeline.set_state(GST_STATE_PLAYING);
    gst_element_get_state(pipeline.get(), nullptr, nullptr, 5 * GST_SECOND);
    g_autoptr(GstQuery) query = gst_query_new_latency();
    ASSERT_TRUE(gst_element_query(pipeline.get(), query));
    gboolean live = FALSE;
    GstClockTime minimum = 0;
    gst_query_parse_latency(query, &live, &minimum, nullptr);
    EXPECT_TRUE(live);
    EXPECT_GE(minimum, GST_SECOND / 40);
    EXPECT_LT(minimum, GST_SECOND / 40 + 25 * GST_MSECOND) << "sinks may add their own";
}

/* Whoever was told that it is sought would wait for its flush. */
TEST(TestSrcStream, cannot_be_sought_in)
{
    Pipeline pipeline("lenssweeptestsrc name=source" + small + "fakesink name=sink");
    pipeline.set_state(GST_STATE_PAUSED);
    gst_element_get_state(pipeline.get(), nullptr, nullptr, 5 * GST_SECOND);
    GstElement *source = pipeline.element("source");
    for (const char *name : {"src", "depth", "motion"}) {
        g_autoptr(GstPad) pad = g_str_equal(name, "src") ? gst_element_get_static_pad(source, name)
                                                         : gst_element_request_pad_simple(source, name);
        EXPECT_FALSE(
            gst_pad_send_event(pad, gst_event_new_seek(1.0, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH,
                                                       GST_SEEK_TYPE_SET, 0, GST_SEEK_TYPE_NONE, 0)));
        g_autoptr(GstQuery) query = gst_query_new_seeking(GST_FORMAT_TIME);
        ASSERT_TRUE(gst_pad_query(pad, query)) << name;
        gboolean seekable = TRUE;
        gst_query_parse_seeking(query, nullptr, &seekable, nullptr, nullptr);
        EXPECT_FALSE(seekable) << name;
    }
}

TEST(TestSrcStream, without_a_live_source_there_is_no_latency)
{
    Pipeline pipeline("lenssweeptestsrc" + small + "fakesink name=sink");
    pipeline.set_state(GST_STATE_PAUSED);
    gst_element_get_state(pipeline.get(), nullptr, nullptr, 5 * GST_SECOND);
    g_autoptr(GstQuery) query = gst_query_new_latency();
    g_autoptr(GstPad) pad = gst_element_get_static_pad(pipeline.element("sink"), "sink");
    ASSERT_TRUE(gst_pad_peer_query(pad, query));
    gboolean live = TRUE;
    gst_query_parse_latency(query, &live, nullptr, nullptr);
    EXPECT_FALSE(live);
}

TEST(TestSrcStream, a_pause_of_a_live_source_loses_no_frame)
{
    Pipeline pipeline("lenssweeptestsrc is-live=true rate=50 planes=2 num-buffers=40" + small +
                      "appsink name=out sync=false");
    for (int i = 0; i < 6; i++) {
        pipeline.set_state(GST_STATE_PLAYING);
        g_usleep(30000);
        pipeline.set_state(GST_STATE_PAUSED);
        g_usleep(10000);
    }
    pipeline.set_state(GST_STATE_PLAYING);
    const auto samples = pipeline.pull_all("out");
    ASSERT_EQ(samples.size(), 40U);
    for (guint i = 0; i < 40; i++)
        EXPECT_EQ(focus_of(samples[i])->frame_id, i);
}

TEST(TestSrcStream, a_sample_outlives_the_pipeline)
{
    Sample sample;
    Sample depth;
    {
        Pipeline pipeline("lenssweeptestsrc name=rig" + small +
                          "queue ! appsink name=out sync=false max-buffers=1 rig.depth ! queue ! "
                          "appsink name=depth sync=false max-buffers=1");
        pipeline.set_state(GST_STATE_PLAYING);
        sample = pipeline.pull("out");
        depth = pipeline.pull("depth");
    }
    EXPECT_EQ(bytes_of(sample.get()).size(), 64U * 48U * 3U / 2U);
    EXPECT_EQ(depth_of(depth.get()).size(), 64U * 48U);
}

TEST(TestSrcStream, two_hundred_starts_and_stops)
{
    for (const char *live : {"false", "true"}) {
        Pipeline pipeline(std::string("lenssweeptestsrc rate=500 name=rig is-live=") + live + small +
                          "queue ! fakesink sync=false rig.depth ! queue ! fakesink sync=false");
        for (int i = 0; i < 100; i++) {
            ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
            if (i % 4 == 0)
                gst_element_get_state(pipeline.get(), nullptr, nullptr, 5 * GST_SECOND);
            g_usleep(static_cast<gulong>(i % 10) * 1000);
            ASSERT_EQ(pipeline.set_state(GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
        }
    }
}

TEST(TestSrcStream, a_stop_while_rendering_does_not_hang)
{
    Pipeline pipeline(
        "lenssweeptestsrc planes=64 motion=3 noise=strong ! video/x-raw,width=4096,height=4096 ! "
        "fakesink");
    pipeline.set_state(GST_STATE_PLAYING);
    g_usleep(300000);
    const auto begin = std::chrono::steady_clock::now();
    pipeline.set_state(GST_STATE_NULL);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST(TestSrcStream, an_end_does_not_wait_for_the_rendering)
{
    Pipeline pipeline("lenssweeptestsrc planes=64 motion=3 noise=strong name=rig ! "
                      "video/x-raw,width=4096,height=4096 ! fakesink rig.depth ! queue ! fakesink");
    pipeline.set_state(GST_STATE_PLAYING);
    g_usleep(300000);
    gst_element_send_event(pipeline.get(), gst_event_new_eos());
    EXPECT_EQ(pipeline.wait(), "");
}

TEST_F(FilesScene, has_the_size_of_its_image)
{
    Pipeline pipeline(
        "lenssweeptestsrc num-buffers=1 " + files("image.png", "depth.png") +
        "name=rig ! video/x-raw,format=RGB ! queue ! appsink name=out sync=false rig.depth ! queue ! "
        "appsink name=depth sync=false");
    pipeline.set_state(GST_STATE_PLAYING);
    const Sample sample = pipeline.pull("out");
    EXPECT_EQ(bytes_of(sample.get()).size(), 40U * 30U * 3U);
    EXPECT_EQ(bytes_of(sample.get())[0], 90) << "red first";
    const auto depth = depth_of(pipeline.pull("depth").get());
    EXPECT_EQ(depth[3], 65535);
    EXPECT_EQ(depth[30], 1);
    EXPECT_EQ(depth[7 * 40 + 3], 0) << "not known";
}

TEST_F(FilesScene, can_be_scaled)
{
    Pipeline pipeline("lenssweeptestsrc num-buffers=1 " + files("image.png", "depth.png") + small +
                      "appsink name=out sync=false");
    pipeline.set_state(GST_STATE_PLAYING);
    EXPECT_NE(pipeline.pull("out"), nullptr);
}

TEST_F(FilesScene, bad_files_are_errors_that_name_them)
{
    EXPECT_NE(error_of(files("none.png", "depth.png"), " ! fakesink").find("none.png"), std::string::npos);
    EXPECT_NE(error_of(files("image.png", "none.png"), " ! fakesink").find("none.png"), std::string::npos);
    EXPECT_NE(error_of(files("image.png", "small.png"), " ! fakesink").find("same size"), std::string::npos);
    EXPECT_NE(error_of("scene=files", " ! fakesink").find("image and depth-map"), std::string::npos);
}

TEST(TestSrcErrors, say_what_to_do)
{
    EXPECT_NE(error_of("noise=loud").find("moderate"), std::string::npos);
    EXPECT_NE(error_of("near=1 far=2").find("near is greater than far"), std::string::npos);
    EXPECT_NE(error_of("powers=\"<1.0>\"").find("2 to 64 planes"), std::string::npos);
    EXPECT_NE(error_of("planes=64 blur-step=50").find("blur-step"), std::string::npos);
    EXPECT_NE(error_of("", " ! video/x-raw,framerate=7/1 ! fakesink").find("planes times rate"),
              std::string::npos);
    EXPECT_NE(error_of("", " ! video/x-raw,width=40000,height=40000 ! fakesink").find("too large"),
              std::string::npos);
    EXPECT_EQ(error_of(""), "");
}

/* The simulated pictures have no fields, and would be told to have some. */
TEST(TestSrcErrors, interlaced_pictures_are_refused)
{
    EXPECT_NE(error_of("num-buffers=1", " ! video/x-raw,interlace-mode=interleaved ! fakesink"), "");
    EXPECT_EQ(error_of("num-buffers=1", " ! video/x-raw,interlace-mode=progressive ! fakesink"), "");
}

TEST(TestSrcErrors, values_out_of_range_are_named_with_the_range)
{
    EXPECT_NE(error_of("planes=100").find("planes=100 is out of range: 2 to 64"), std::string::npos);
    EXPECT_NE(error_of("planes=1").find("planes=1 is out of range"), std::string::npos);
    EXPECT_NE(error_of("rate=0").find("rate=0 is out of range: 0.01 to 1000"), std::string::npos);
    EXPECT_NE(error_of("blur-step=200").find("blur-step=200 is out of range"), std::string::npos);
    EXPECT_NE(error_of("blur-step=-0.5").find("blur-step is 0 to 100 pixels, or -1"), std::string::npos);
    EXPECT_NE(error_of("breathing=0.7").find("breathing=0.7 is out of range: -0.5 to 0.5"),
              std::string::npos);
    EXPECT_NE(error_of("near=2000").find("near=2000 is out of range"), std::string::npos);
}

TEST(TestSrcErrors, a_long_rendering_tells_how_far_it_is)
{
    Pipeline pipeline(
        "lenssweeptestsrc num-buffers=1 planes=16 blur-step=3 ! video/x-raw,width=320,height=240 ! "
        "fakesink");
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline.get());
    pipeline.set_state(GST_STATE_PLAYING);
    bool told = false;
    bool over = false;
    GstMessageType type = GST_MESSAGE_UNKNOWN;
    while (type != GST_MESSAGE_EOS) {
        g_autoptr(GstMessage) message = gst_bus_timed_pop_filtered(
            bus, patience,
            static_cast<GstMessageType>(GST_MESSAGE_PROGRESS | GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
        ASSERT_NE(message, nullptr);
        type = GST_MESSAGE_TYPE(message);
        ASSERT_NE(type, GST_MESSAGE_ERROR);
        if (type != GST_MESSAGE_PROGRESS)
            continue;
        GstProgressType progress = GST_PROGRESS_TYPE_ERROR;
        g_autofree gchar *code = nullptr;
        g_autofree gchar *text = nullptr;
        gst_message_parse_progress(message, &progress, &code, &text);
        EXPECT_STREQ(code, "render");
        told |= progress == GST_PROGRESS_TYPE_START && std::string(text).find(" of 16") != std::string::npos;
        over |= progress == GST_PROGRESS_TYPE_COMPLETE;
    }
    EXPECT_TRUE(told && over);
}

TEST(TestSrcErrors, a_bad_change_while_playing_is_an_error)
{
    Pipeline pipeline("lenssweeptestsrc name=rig" + small + "fakesink");
    pipeline.set_state(GST_STATE_PLAYING);
    g_usleep(100000);
    g_object_set(pipeline.element("rig"), "noise", "loud", nullptr);
    EXPECT_NE(pipeline.wait().find("loud"), std::string::npos);
}

TEST(TestSrcLatency, can_be_asked_for_while_the_source_starts_and_stops)
{
    Pipeline pipeline("lenssweeptestsrc name=rig is-live=true" + small + "fakesink");
    std::atomic<bool> done = false;
    std::atomic<int> answers = 0;
    std::thread other([&] {
        g_autoptr(GstPad) pad = gst_element_get_static_pad(pipeline.element("rig"), "src");
        while (!done) {
            g_autoptr(GstQuery) query = gst_query_new_latency();
            answers += gst_pad_query(pad, query) ? 1 : 0;
        }
    });
    for (int i = 0; i < 300; i++) {
        gst_element_set_state(pipeline.element("rig"), GST_STATE_PAUSED);
        gst_element_set_state(pipeline.element("rig"), GST_STATE_READY);
    }
    done = true;
    other.join();
    EXPECT_GT(answers, 0);
}

TEST(TestSrcPipelines, documented_ones_run)
{
    EXPECT_EQ(Pipeline("lenssweeptestsrc num-buffers=60 ! videoconvert ! fakesink").run(), "");
    EXPECT_EQ(Pipeline("lenssweeptestsrc name=rig num-buffers=60 noise=moderate ! queue ! fakesink "
                       "rig.depth ! queue ! fakesink")
                  .run(),
              "");
}
