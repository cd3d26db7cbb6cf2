/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* lenssweepsrc with the camera that Aravis simulates in this process: no network. */
#include "../lenssweep/support.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <thread>
#include <unistd.h>

namespace {

const std::string camera =
    "lenssweepsrc name=camera camera=Fake_1 trigger=free-run planes=4 rate=15 exposure=5000 ";
const std::string out = "! appsink name=out sync=false";

guint64 statistic(const Pipeline &pipeline, const char *name)
{
    g_autoptr(GstStructure) stats = nullptr;
    g_object_get(pipeline.element("camera"), "stats", &stats, nullptr);
    guint64 value = 0;
    EXPECT_TRUE(gst_structure_get_uint64(stats, name, &value)) << name;
    return value;
}

std::size_t entries(const char *folder)
{
    const std::filesystem::directory_iterator begin(folder);
    return static_cast<std::size_t>(std::distance(begin, std::filesystem::directory_iterator()));
}

unsigned cycles()
{
    const char *value = std::getenv("DFF_CYCLES");
    return value ? static_cast<unsigned>(std::stoul(value)) : 20;
}

/* What a pipeline that fails says: its errors and warnings, in order. */
std::vector<std::string> words_of_failure(const std::string &description)
{
    Pipeline pipeline(description);
    pipeline.set_state(GST_STATE_PLAYING);
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline.get());
    std::vector<std::string> words;
    GstClockTime patience = 20 * GST_SECOND;
    while (GstMessage *message = gst_bus_timed_pop_filtered(
               bus, patience, static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_WARNING))) {
        g_autoptr(GError) error = nullptr;
        if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
            gst_message_parse_error(message, &error, nullptr);
            words.push_back(std::string("error: ") + error->message);
            patience = 200 * GST_MSECOND; /* for what may follow */
        } else {
            gst_message_parse_warning(message, &error, nullptr);
            words.push_back(std::string("warning: ") + error->message);
        }
        gst_message_unref(message);
    }
    return words;
}

std::ptrdiff_t how_many(const std::vector<std::string> &words, const char *part)
{
    return std::count_if(words.begin(), words.end(),
                         [part](const std::string &text) { return text.find(part) != std::string::npos; });
}

std::string warning_of(const std::string &description)
{
    Pipeline pipeline(description);
    pipeline.set_state(GST_STATE_PLAYING);
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline.get());
    g_autoptr(GstMessage) message = gst_bus_timed_pop_filtered(
        bus, 10 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_WARNING | GST_MESSAGE_EOS));
    if (!message || GST_MESSAGE_TYPE(message) != GST_MESSAGE_WARNING)
        return "";
    g_autoptr(GError) error = nullptr;
    gst_message_parse_warning(message, &error, nullptr);
    return error->message;
}

} // namespace

TEST(LensSweepSrc, a_calibration_knows_better_where_planes_are)
{
    const std::string file = testing::TempDir() + "focus" + std::to_string(getpid()) + ".yml";
    g_file_set_contents(
        file.c_str(),
        "%YAML:1.0\n---\nfocus:\n   vergences: [ 3., 1.9, 1.2, 0.1 ]\n   field: [ 0., 0., 0. ]\n", -1,
        nullptr);
    Pipeline pipeline(camera + "num-buffers=8 calibration=" + file + " " + out);
    pipeline.set_state(GST_STATE_PLAYING);
    const auto samples = pipeline.pull_all("out");
    EXPECT_EQ(samples.size(), 8U);
    const double powers[] = {3.0, 1.9, 1.2, 0.1};
    for (const auto &sample : samples)
        EXPECT_DOUBLE_EQ(focus_of(sample)->power, powers[focus_of(sample)->plane]);
    unlink(file.c_str());
}

TEST(LensSweepSrc, planes_follow_each_other)
{
    Pipeline pipeline(camera + "num-buffers=12 " + out);
    pipeline.set_state(GST_STATE_PLAYING);
    const auto samples = pipeline.pull_all("out");
    ASSERT_EQ(samples.size(), 12U);
    const guint64 first_sweep = focus_of(samples[0])->sweep;
    GstClockTime last = 0;
    for (guint i = 0; i < samples.size(); i++) {
        const GstFocusMeta *focus = focus_of(samples[i]);
        ASSERT_NE(focus, nullptr);
        if (statistic(pipeline, "restarts") == 0 && statistic(pipeline, "lost") == 0) {
            EXPECT_EQ(focus->plane, i % 4);
            EXPECT_EQ(focus->sweep, first_sweep + i / 4);
        }
        EXPECT_EQ(focus->planes, 4U);
        EXPECT_EQ(focus->exposure, 5 * GST_MSECOND);
        EXPECT_DOUBLE_EQ(focus->power, 5.0 - 5.0 * focus->plane / 3);
        const GstBuffer *buffer = gst_sample_get_buffer(samples[i].get());
        EXPECT_GE(GST_BUFFER_PTS(buffer), last);
        last = GST_BUFFER_PTS(buffer);
    }
    EXPECT_EQ(statistic(pipeline, "delivered"), 12U);
}

TEST(LensSweepSrc, a_frame_whose_exposure_began_before_the_stream_is_not_left_out)
{
    Pipeline pipeline(
        "lenssweepsrc camera=Fake_1 trigger=free-run planes=4 rate=15 exposure=5000000 num-buffers=1 " + out);
    pipeline.set_state(GST_STATE_PLAYING);
    const Sample sample = pipeline.pull("out");
    ASSERT_NE(sample, nullptr) << pipeline.wait();
    EXPECT_EQ(focus_of(sample)->plane, 0U);
    EXPECT_EQ(GST_BUFFER_PTS(gst_sample_get_buffer(sample.get())), 0U);
}

TEST(LensSweepSrc, the_cameras_own_time_is_told)
{
    Pipeline pipeline(camera + "num-buffers=1 " + out);
    pipeline.set_state(GST_STATE_PLAYING);
    const Sample sample = pipeline.pull("out");
    ASSERT_NE(sample, nullptr);
    g_autoptr(GstCaps) caps = gst_caps_new_empty_simple("timestamp/x-camera");
    const auto *meta = gst_buffer_get_reference_timestamp_meta(gst_sample_get_buffer(sample.get()), caps);
    ASSERT_NE(meta, nullptr);
    EXPECT_GT(meta->timestamp, 0U);
}

TEST(LensSweepSrc, a_pts_is_the_begin_of_the_exposure)
{
    Pipeline pipeline(camera + "num-buffers=8 ! appsink name=out sync=false");
    pipeline.set_state(GST_STATE_PLAYING);
    for (int i = 0; i < 8; i++) {
        const Sample sample = pipeline.pull("out");
        ASSERT_NE(sample, nullptr);
        const GstClockTime now = gst_element_get_current_running_time(pipeline.get());
        const GstClockTime pts = GST_BUFFER_PTS(gst_sample_get_buffer(sample.get()));
        if (i == 0 && pts == 0)
            continue; /* it began before the stream did */
        EXPECT_LE(pts + 5 * GST_MSECOND, now);
        EXPECT_LT(now, pts + GST_SECOND) << "even on a busy machine";
    }
}

TEST(LensSweepSrc, a_sample_outlives_the_pipeline)
{
    Sample sample;
    {
        Pipeline pipeline(camera + out);
        pipeline.set_state(GST_STATE_PLAYING);
        sample = pipeline.pull("out");
        pipeline.pull("out");
    }
    const auto bytes = bytes_of(sample.get());
    EXPECT_EQ(bytes.size(), 512U * 512U);
    gst_buffer_memset(gst_sample_get_buffer(sample.get()), 0, 7, bytes.size());
}

TEST(LensSweepSrc, a_sample_that_is_kept_is_not_written_over)
{
    Pipeline pipeline(camera + "! queue ! " + out.substr(2));
    pipeline.set_state(GST_STATE_PLAYING);
    const Sample kept = pipeline.pull("out");
    const auto before = bytes_of(kept.get());
    for (int i = 0; i < 40; i++)
        ASSERT_NE(pipeline.pull("out"), nullptr);
    EXPECT_EQ(bytes_of(kept.get()), before);
}

TEST(LensSweepSrc, every_format_has_the_strides_of_its_caps)
{
    for (const char *caps :
         {"video/x-raw,format=GRAY8,width=322,height=242", "video/x-raw,format=GRAY16_LE,width=321",
          "video/x-raw,format=RGB,width=322", "video/x-raw,format=GRAY8,width=320"}) {
        Pipeline pipeline(camera + "num-buffers=2 ! " + caps + " " + out);
        pipeline.set_state(GST_STATE_PLAYING);
        const Sample sample = pipeline.pull("out");
        ASSERT_NE(sample, nullptr) << caps << ": " << pipeline.wait();
        const GstVideoInfo info = info_of(sample.get());
        EXPECT_EQ(bytes_of(sample.get()).size(), GST_VIDEO_INFO_SIZE(&info)) << caps;
    }
    EXPECT_EQ(Pipeline(camera + "num-buffers=2 ! video/x-bayer,format=rggb ! bayer2rgb ! fakesink").run(),
              "");
}

TEST(LensSweepSrc, odd_sizes_of_bayer_are_rounded_down_with_a_warning)
{
    const std::string odd = camera + "features=\"Width=321 Height=243\" num-buffers=1 ! video/x-bayer ";
    Pipeline pipeline(odd + out);
    pipeline.set_state(GST_STATE_PLAYING);
    const Sample sample = pipeline.pull("out");
    ASSERT_NE(sample, nullptr);
    EXPECT_EQ(bytes_of(sample.get()).size(), 320U * 242U);
    EXPECT_NE(warning_of(odd + "! fakesink").find("321x243"), std::string::npos);
}

TEST(LensSweepSrc, exposure_gain_and_rate_change_while_playing)
{
    Pipeline pipeline(camera + out + " max-buffers=4 drop=true");
    pipeline.set_state(GST_STATE_PLAYING);
    ASSERT_NE(pipeline.pull("out"), nullptr);
    g_object_set(pipeline.element("camera"), "exposure", 2000.0, "gain", 3.0, "rate", 30.0, nullptr);
    bool changed = false;
    for (int i = 0; i < 200 && !changed; i++) {
        const Sample sample = pipeline.pull("out");
        ASSERT_NE(sample, nullptr) << pipeline.wait();
        const GstVideoInfo info = info_of(sample.get());
        changed = focus_of(sample)->exposure == 2 * GST_MSECOND && GST_VIDEO_INFO_FPS_N(&info) == 120;
    }
    EXPECT_TRUE(changed);
    g_autoptr(GstQuery) query = gst_query_new_latency();
    ASSERT_TRUE(gst_element_query(pipeline.element("camera"), query));
    gboolean live = FALSE;
    GstClockTime least = 0;
    gst_query_parse_latency(query, &live, &least, nullptr);
    EXPECT_TRUE(live);
    EXPECT_NEAR(static_cast<double>(least), 2e6 + 1e9 / 120, 1e4);
}

/* Another thread may set the rate between the start and the negotiation, and set it back before the first
 * frame. */
TEST(LensSweepSrc, a_rate_that_is_taken_back_while_caps_are_negotiated_is_not_told)
{
    Pipeline pipeline(camera + "num-buffers=1 " + out);
    GstElement *source = pipeline.element("camera");
    const auto set_other_rate = [](GstPad *, GstPadProbeInfo *info, gpointer element) {
        if (GST_QUERY_TYPE(GST_PAD_PROBE_INFO_QUERY(info)) == GST_QUERY_CAPS)
            g_object_set(element, "rate", 30.0, nullptr);
        return GST_PAD_PROBE_OK;
    };
    g_autoptr(GstPad) pad = gst_element_get_static_pad(source, "src");
    const gulong probe =
        gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_QUERY_UPSTREAM, set_other_rate, source, nullptr);
    pipeline.set_state(GST_STATE_PAUSED);
    while (!gst_pad_has_current_caps(pad))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    gst_pad_remove_probe(pad, probe);
    g_object_set(source, "rate", 15.0, nullptr);
    pipeline.set_state(GST_STATE_PLAYING);
    const Sample sample = pipeline.pull("out");
    ASSERT_NE(sample, nullptr) << pipeline.wait();
    const GstVideoInfo info = info_of(sample.get());
    EXPECT_EQ(GST_VIDEO_INFO_FPS_N(&info), 60);
}

TEST(LensSweepSrc, sweeps_go_on_rising_when_the_rate_changes)
{
    Pipeline pipeline(camera + out);
    pipeline.set_state(GST_STATE_PLAYING);
    guint64 last = 0;
    for (int i = 0; i < 60; i++) {
        const Sample sample = pipeline.pull("out");
        ASSERT_NE(sample, nullptr);
        EXPECT_GE(focus_of(sample)->sweep, last);
        last = focus_of(sample)->sweep;
        if (i == 20)
            g_object_set(pipeline.element("camera"), "rate", 25.0, nullptr);
    }
    EXPECT_GT(last, 5U);
}

TEST(LensSweepSrc, silence_of_the_trigger_is_no_error_and_can_be_stopped_at_once)
{
    Pipeline pipeline("lenssweepsrc camera=Fake_1 trigger=free-run planes=2 rate=0.5 ! fakesink");
    for (int i = 0; i < 4; i++) {
        pipeline.set_state(GST_STATE_PLAYING);
        g_usleep(static_cast<gulong>(i) * 20000);
        const auto begin = std::chrono::steady_clock::now();
        pipeline.set_state(GST_STATE_PAUSED);
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(500));
    }
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline.get());
    g_autoptr(GstMessage) error = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
    EXPECT_EQ(error, nullptr);
}

TEST(LensSweepSrc, nobody_who_tells_the_plane_is_warned_of)
{
    const std::string warning = warning_of("lenssweepsrc camera=Fake_1 ! fakesink");
    EXPECT_NE(warning.find("sync-line or run-line"), std::string::npos) << warning;
}

TEST(LensSweepSrc, a_simulated_camera_that_is_to_be_triggered_is_warned_of)
{
    const std::string warning = warning_of("lenssweepsrc camera=Fake_1 trigger=software ! fakesink");
    EXPECT_NE(warning.find("trigger=free-run"), std::string::npos) << warning;
    EXPECT_EQ(warning_of(camera + "num-buffers=1 ! fakesink"), "");
}

TEST(LensSweepSrc, trigger_timeout_is_an_error_that_says_what_to_look_at)
{
    const std::string error = Pipeline("lenssweepsrc camera=Fake_1 trigger=free-run planes=2 rate=0.5 "
                                       "trigger-timeout=50000000 ! fakesink")
                                  .run();
    EXPECT_NE(error.find("trigger-timeout"), std::string::npos) << error;
    EXPECT_EQ(error.find("sequencer"), std::string::npos) << "a camera that runs freely has none: " << error;
}

TEST(LensSweepSrc, pictures_that_nobody_takes_are_an_error_that_says_so)
{
    for (const char *filter : {"width=9999", "framerate=7/1"}) {
        const std::string error = Pipeline(camera + "! video/x-raw," + filter + " ! fakesink").run();
        EXPECT_NE(error.find("planes times rate"), std::string::npos) << filter << ": " << error;
    }
}

TEST(LensSweepSrc, a_new_rate_that_nobody_takes_is_an_error_that_says_so)
{
    Pipeline pipeline(camera + "! video/x-raw,framerate=60/1 " + out);
    pipeline.set_state(GST_STATE_PLAYING);
    ASSERT_NE(pipeline.pull("out"), nullptr) << pipeline.wait();
    g_object_set(pipeline.element("camera"), "rate", 20.0, nullptr);
    const std::string error = pipeline.wait();
    EXPECT_NE(error.find("frame rate of 80/1"), std::string::npos) << error;
}

TEST(LensSweepSrc, errors_say_what_to_do)
{
    const auto error = [](const std::string &properties) {
        return Pipeline("lenssweepsrc camera=Fake_1 " + properties + " ! fakesink").run();
    };
    EXPECT_NE(error("trigger-source=Line7").find("Line0, Software"), std::string::npos);
    EXPECT_NE(error("trigger=free-run near=1 far=2").find("near"), std::string::npos);
    EXPECT_NE(error("trigger=free-run exposure=99999999").find("range"), std::string::npos);
    EXPECT_NE(error("trigger=free-run gain=99").find("range"), std::string::npos);
    EXPECT_NE(error("trigger=free-run lens=warp:drive").find("fpga"), std::string::npos);
    EXPECT_NE(error("trigger=free-run features=NoSuch=1").find("NoSuch"), std::string::npos);
    EXPECT_NE(error("trigger=free-run sync-line=SYNC").find("trigger=line"), std::string::npos);
    EXPECT_NE(error("trigger=free-run lens-profile=/no/lens.yaml").find("lens that is moved"),
              std::string::npos);
}

TEST(LensSweepSrc, an_error_is_the_only_one)
{
    for (const char *properties :
         {"trigger-source=Line7", "camera=NoSuchCamera", "trigger=free-run near=1 far=2",
          "trigger=free-run planes=2 rate=0.5 trigger-timeout=50000000",
          "trigger=free-run ! video/x-raw,width=9999"}) {
        const auto words =
            words_of_failure(std::string("lenssweepsrc camera=Fake_1 ") + properties + " ! fakesink");
        EXPECT_EQ(how_many(words, "error: "), 1) << properties << ": " << words.back();
    }
}

TEST(LensSweepSrc, after_an_error_the_next_start_can_fail_and_say_so_again)
{
    Pipeline pipeline("lenssweepsrc camera=NoSuchCamera ! fakesink");
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline.get());
    for (int i = 0; i < 2; i++) {
        EXPECT_EQ(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
        g_autoptr(GstMessage) error = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
        EXPECT_NE(error, nullptr);
        pipeline.set_state(GST_STATE_NULL);
    }
}

TEST(LensSweepSrc, frames_that_come_and_get_no_plane_are_warned_of)
{
    const auto words =
        words_of_failure("lenssweepsrc camera=Fake_1 trigger=software planes=2 rate=4 ! fakesink");
    EXPECT_EQ(how_many(words, "The planes of the last 40 frames cannot be told"), 1);
}

TEST(LensSweepSrc, an_exposure_longer_than_the_period_is_warned_of_with_the_figures)
{
    const std::string warning = warning_of("lenssweepsrc camera=Fake_1 trigger=free-run planes=4 rate=10 "
                                           "exposure=30000 num-buffers=1 ! fakesink");
    EXPECT_NE(warning.find("30000 us"), std::string::npos) << warning;
    EXPECT_NE(warning.find("25000 us"), std::string::npos) << warning;
}

TEST(LensSweepSrc, a_stack_comes_of_its_planes)
{
    EXPECT_EQ(Pipeline(camera + "num-buffers=12 ! focalstackmux ! fakesink").run(), "");
}

TEST(LensSweepSrc, two_at_once_do_not_disturb_each_other)
{
    const std::string second = "lenssweepsrc name=second camera=Fake_2 trigger=free-run planes=3 rate=20 "
                               "exposure=5000 ! appsink name=other sync=false";
    Pipeline both(camera + out + " " + second);
    for (int cycle = 0; cycle < 3; cycle++) {
        both.set_state(GST_STATE_PLAYING);
        for (guint i = 0; i < 12; i++) {
            const Sample one = both.pull("out");
            const Sample other = both.pull("other");
            ASSERT_TRUE(one && other) << both.wait();
            EXPECT_EQ(focus_of(one)->planes, 4U);
            EXPECT_EQ(focus_of(other)->planes, 3U);
        }
        EXPECT_EQ(both.set_state(GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
    }
}

TEST(LensSweepSrc, starts_and_stops_leak_no_thread_and_no_file)
{
    Pipeline pipeline(camera + "! fakesink sync=false");
    std::size_t threads = 0;
    std::size_t files = 0;
    for (unsigned i = 0; i < cycles(); i++) {
        pipeline.set_state(GST_STATE_PLAYING);
        g_usleep(static_cast<gulong>(i % 8) * 5000);
        ASSERT_EQ(pipeline.set_state(GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
        if (i == 4) {
            threads = entries("/proc/self/task");
            files = entries("/proc/self/fd");
        }
    }
    /* GStreamer's and GLib's thread pools end their threads a little later. */
    for (int i = 0; i < 100 && entries("/proc/self/task") > threads; i++)
        g_usleep(50000);
    EXPECT_LE(entries("/proc/self/task"), threads);
    EXPECT_LE(entries("/proc/self/fd"), files);
}

TEST(LensSweepSrc, properties_can_be_hammered_from_another_thread)
{
    Pipeline pipeline(camera + "! fakesink sync=false");
    pipeline.set_state(GST_STATE_PLAYING);
    std::atomic<bool> done = false;
    std::thread other([&] {
        for (int i = 0; !done; i++) {
            g_object_set(pipeline.element("camera"), "exposure", 1000.0 + i % 100, "gain", 1.0 * (i % 5),
                         nullptr);
            statistic(pipeline, "delivered");
            g_usleep(2000);
        }
    });
    for (int i = 0; i < 5; i++) {
        g_usleep(50000);
        pipeline.set_state(GST_STATE_PAUSED);
        pipeline.set_state(GST_STATE_PLAYING);
    }
    done = true;
    other.join();
    EXPECT_EQ(pipeline.set_state(GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
}
