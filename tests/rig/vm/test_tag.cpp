/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lens/found_lenses.h"
#include "rig.h"
#include "support.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <gst/video/video.h>
#include <gtest/gtest.h>
#include <map>
#include <thread>

namespace {

constexpr const char *camera =
    "v4l2src device=/dev/video0 ! video/x-raw,format=YUY2,width=320,height=180,framerate=15/1 ! ";

/* Mean of the luma of a YUY2 frame. */
double brightness(GstSample *sample)
{
    const auto bytes = bytes_of(sample);
    double sum = 0;
    for (size_t i = 0; i < bytes.size(); i += 2)
        sum += bytes[i];
    return sum / (static_cast<double>(bytes.size()) / 2);
}

guint64 count_of(GstElement *tag, const char *name)
{
    g_autoptr(GstStructure) stats = nullptr;
    guint64 count = 0;
    g_object_get(tag, "stats", &stats, nullptr);
    gst_structure_get_uint64(stats, name, &count);
    return count;
}

GstPadProbeReturn note_first(GstPad *, GstPadProbeInfo *info, gpointer first)
{
    *static_cast<std::atomic<GstClockTime> *>(first) = GST_BUFFER_PTS(GST_PAD_PROBE_INFO_BUFFER(info));
    return GST_PAD_PROBE_REMOVE;
}

} // namespace

/* The rig's lens shows its position as the picture's brightness, 60 ms after it was moved. */
TEST(StepMode, frames_show_the_lens_at_the_plane_of_their_label)
{
    Pipeline pipeline(std::string(camera) +
                      "lenssweeptag name=tag lens=v4l2:/dev/video0 mode=step planes=3 near=2 far=0 ! "
                      "appsink name=out max-buffers=100");
    ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
    std::map<unsigned, std::pair<double, double>> range; /* of the brightness, by plane */
    for (guint64 i = 0; i < 9; ++i) {
        const Sample sample = pipeline.pull("out");
        ASSERT_TRUE(sample) << pipeline.wait();
        const GstFocusMeta *focus = focus_of(sample);
        ASSERT_NE(focus, nullptr);
        EXPECT_EQ(focus->sweep, i / 3);
        EXPECT_EQ(focus->plane, i % 3);
        EXPECT_EQ(focus->code, 220 - 90 * static_cast<int>(i % 3));
        EXPECT_TRUE(std::isnan(focus->power));
        const double light = brightness(sample.get());
        auto &[low, high] = range.try_emplace(focus->plane, light, light).first->second;
        low = std::min(low, light);
        high = std::max(high, light);
    }
    EXPECT_GT(range[0].first, range[1].second + 10) << "the nearest plane is the brightest";
    EXPECT_GT(range[1].first, range[2].second + 10);
    for (const auto &[plane, lights] : range)
        EXPECT_LT(lights.second - lights.first, 5) << "plane " << plane;
    GstElement *tag = pipeline.element("tag");
    EXPECT_GE(count_of(tag, "labelled"), 9U);
    EXPECT_GE(count_of(tag, "dropped"), 9U);
}

/* The bus tells when the lens was told what. A frame comes, and is stamped, as its exposure ends: from a
 * settle time before that began, the lens must have had no other code than that of the label. */
TEST(StepMode, no_frame_is_labelled_that_a_lens_driver_was_not_at_rest_for)
{
    constexpr unsigned planes = 3;
    constexpr unsigned labelled = 60;
    constexpr guint64 exposure = GST_SECOND / 30; /* as long as the frame's time */
    constexpr guint64 settle = 20 * GST_MSECOND;  /* of the nominal profile */
    rig::empty_i2c_log();                         /* which is full after so many lines */
    Pipeline pipeline(
        "videotestsrc is-live=true ! video/x-raw,width=64,height=64,framerate=30/1 ! lenssweeptag name=tag "
        "lens=max14574:" +
        rig::i2c_bus() + " mode=step planes=3 near=5 far=0 ! appsink name=out max-buffers=200");
    ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
    std::vector<Sample> samples;
    while (samples.size() < labelled) {
        samples.push_back(pipeline.pull("out"));
        ASSERT_TRUE(samples.back()) << pipeline.wait();
    }
    const auto commits = rig::lens_commits();
    const guint64 base = gst_element_get_base_time(pipeline.get());
    for (size_t i = 0; i < labelled; ++i) {
        const GstFocusMeta *focus = focus_of(samples[i]);
        EXPECT_EQ(focus->sweep, i / planes);
        EXPECT_EQ(focus->plane, i % planes);
        EXPECT_DOUBLE_EQ(focus->power, 5.0 - 2.5 * static_cast<double>(i % planes));
        const guint64 end = base + GST_BUFFER_PTS(gst_sample_get_buffer(samples[i].get()));
        const auto after = std::find_if(commits.begin(), commits.end(), [&](const rig::Commit &commit) {
            return commit.time_ns > end - exposure - settle;
        });
        ASSERT_NE(after, commits.begin());
        EXPECT_EQ(std::prev(after)->code, focus->code) << "frame " << i;
        EXPECT_TRUE(after == commits.end() || after->time_ns >= end) << "frame " << i;
    }
    pipeline.set_state(GST_STATE_NULL);
    EXPECT_EQ(rig::i2c_log().back(), "77 03=00") << "asleep";
}

TEST(StepMode, lenses_are_listed_and_errors_tell_of_them)
{
    g_autoptr(GstDeviceProvider) provider =
        gst_device_provider_factory_get_by_name("focuslensdeviceprovider");
    ASSERT_NE(provider, nullptr);
    GList *devices = gst_device_provider_get_devices(provider);
    std::string launch;
    for (GList *item = devices; item; item = item->next) {
        g_autoptr(GstStructure) properties = gst_device_get_properties(GST_DEVICE(item->data));
        launch += gst_structure_get_string(properties, "lens.range");
        launch += std::string(": ") + gst_structure_get_string(properties, "launch") + "\n";
    }
    EXPECT_NE(launch.find("focus 40 to 220: v4l2src device=/dev/video0 ! lenssweeptag mode=step "
                          "lens=v4l2:/dev/video0\n"),
              std::string::npos)
        << launch;
    const bool libcamera_moves_it =
        launch.find("focus 0 to 1023: libcamerasrc name=cam ! lenssweeptag mode=step "
                    "lens=element:cam.lens-position\n") != std::string::npos;
    EXPECT_TRUE(libcamera_moves_it ||
                launch.find("focus 0 to 1023: ... ! lenssweeptag mode=step lens=v4l2:/dev/v4l-subdev") !=
                    std::string::npos)
        << launch;
    g_list_free_full(devices, gst_object_unref);
    Pipeline pipeline("videotestsrc ! lenssweeptag mode=step lens=v4l2:/dev/video77 ! fakesink");
    EXPECT_NE(pipeline.run().find("focus 40 to 220, lens=v4l2:/dev/video0"), std::string::npos);
}

TEST(StepMode, bus_that_does_not_answer_ends_in_an_error_and_may_come_back)
{
    Pipeline pipeline("videotestsrc is-live=true ! video/x-raw,framerate=30/1 ! lenssweeptag lens=max14574:" +
                      rig::i2c_bus() + " mode=step planes=2 ! appsink name=out max-buffers=100");
    ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
    ASSERT_TRUE(pipeline.pull("out"));
    rig::fail_i2c_transfers(1000000);
    const std::string error = pipeline.wait();
    rig::fail_i2c_transfers(0);
    EXPECT_NE(error.find("sweep has stopped"), std::string::npos) << error;
    pipeline.set_state(GST_STATE_NULL);
    ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
    EXPECT_TRUE(pipeline.pull("out")) << "it is back again";
}

/* The lens of vimc is a driver's device, which its driver can be taken from, and given to again. */
TEST(StepMode, a_lens_that_is_unplugged_in_mid_sweep_ends_in_an_error_and_may_come_back)
{
    const auto found = [] {
        for (const dff::FoundLens &lens : dff::find_lenses(dff::this_machine()))
            if (lens.kind == dff::FoundLens::Kind::Subdevice)
                return lens.device;
        return std::string();
    };
    const std::string before = found();
    ASSERT_NE(before, "");
    Pipeline pipeline("videotestsrc is-live=true ! video/x-raw,width=64,height=64,framerate=30/1 ! "
                      "lenssweeptag name=tag mode=step settle-frames=0 planes=3 near=2 far=0 lens=v4l2:" +
                      before + " ! appsink name=out max-buffers=100");
    ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
    for (unsigned frame = 0; frame < 4; ++frame) {
        const Sample sample = pipeline.pull("out");
        ASSERT_TRUE(sample) << pipeline.wait();
        EXPECT_EQ(focus_of(sample)->plane, frame % 3);
    }
    const std::string driver = "/sys/bus/platform/drivers/vimc/";
    ASSERT_TRUE(std::filesystem::exists(driver + "vimc.0"));
    rig::write_file(driver + "unbind", "vimc.0");
    const std::string error = pipeline.wait();
    EXPECT_NE(error.find(before + " was unplugged"), std::string::npos) << error;
    pipeline.set_state(GST_STATE_NULL);
    EXPECT_EQ(found(), "");

    rig::write_file(driver + "bind", "vimc.0");
    const std::string after = found();
    ASSERT_NE(after, "");
    g_object_set(pipeline.element("tag"), "lens", ("v4l2:" + after).c_str(), nullptr);
    ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
    EXPECT_TRUE(pipeline.pull("out")) << "it is back again";
}

TEST(SyncMode, frames_are_labelled_by_the_edges_of_the_line)
{
    constexpr guint64 planes = 3;
    constexpr GstClockTime period = GST_SECOND / 2; /* an emulated machine may be late by a tenth */
    Pipeline pipeline(
        "videotestsrc is-live=true num-buffers=30 ! video/x-raw,width=64,height=64,framerate=2/1 ! "
        "identity sleep-time=250000 ! lenssweeptag name=tag mode=sync sync-line=SYNC planes=3 near=2 far=0 ! "
        "appsink name=out max-buffers=100");
    std::atomic<GstClockTime> first = GST_CLOCK_TIME_NONE; /* PTS of the first frame */
    g_autoptr(GstPad) pad = gst_element_get_static_pad(pipeline.element("tag"), "sink");
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, note_first, &first, nullptr);
    ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);

    /* The sequencer: an edge at the time of every third frame, which comes half a period later, as from a
     * camera. */
    std::jthread sequencer([&](const std::stop_token &stop) {
        while (first == GST_CLOCK_TIME_NONE && !stop.stop_requested())
            std::this_thread::sleep_for(std::chrono::milliseconds{5});
        g_autoptr(GstClock) clock = gst_system_clock_obtain();
        const GstClockTime begin = gst_element_get_base_time(pipeline.get()) + first;
        for (guint64 sweep = 1; sweep < 10 && !stop.stop_requested(); ++sweep) {
            GstClockID edge = gst_clock_new_single_shot_id(clock, begin + sweep * planes * period);
            gst_clock_id_wait(edge, nullptr);
            gst_clock_id_unref(edge);
            rig::pull(rig::sync_line, true);
            rig::pull(rig::sync_line, false);
        }
    });
    const auto samples = pipeline.pull_all("out");
    EXPECT_GE(samples.size(), 6U);
    for (const auto &sample : samples) {
        const GstClockTime time = GST_BUFFER_PTS(gst_sample_get_buffer(sample.get())) - first;
        const guint64 frame = (time + period / 2) / period;
        ASSERT_NE(focus_of(sample), nullptr);
        EXPECT_EQ(focus_of(sample)->plane, frame % planes) << "frame " << frame;
    }
    GstElement *tag = pipeline.element("tag");
    EXPECT_EQ(count_of(tag, "frames"), 30U);
    EXPECT_EQ(count_of(tag, "labelled") + count_of(tag, "dropped"), 30U);
}

TEST(SyncMode, sequencer_that_does_not_answer_ends_in_an_error_and_may_come_back)
{
    Pipeline pipeline(
        "videotestsrc is-live=true ! video/x-raw,width=64,height=64,framerate=100/1 ! lenssweeptag mode=sync "
        "sync-line=SYNC lens=fpga:" +
        rig::i2c_bus() + " planes=3 near=2 far=0 ! fakesink");
    ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
    std::this_thread::sleep_for(std::chrono::milliseconds{200});
    rig::fail_i2c_transfers(1000000);
    const std::string error = pipeline.wait();
    rig::fail_i2c_transfers(0);
    EXPECT_NE(error.find("sweep has stopped"), std::string::npos) << error;
    pipeline.set_state(GST_STATE_NULL);

    rig::empty_i2c_log();
    ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
    std::this_thread::sleep_for(std::chrono::milliseconds{500});
    const auto log = rig::i2c_log();
    EXPECT_NE(std::find(log.begin(), log.end(), "3c 0c=0001"), log.end()) << "no table was committed again";
}
