/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "support.h"

#include <atomic>
#include <cmath>
#include <glib/gstdio.h>
#include <gst/check/gstharness.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace {

/* lenssweeptag planes=4 with raw frames going in. */
class Tag : public testing::Test {
protected:
    void start(const char *element = "lenssweeptag planes=4 near=3 far=0",
               const char *caps = "video/x-raw,format=GRAY8,width=8,height=4,framerate=100/1")
    {
        harness_ = gst_harness_new_parse(element);
        gst_element_set_bus(harness_->element, bus_);
        gst_harness_set_src_caps_str(harness_, caps);
    }

    void TearDown() override
    {
        gst_element_set_bus(harness_->element, nullptr);
        gst_harness_teardown(harness_);
        gst_object_unref(bus_);
    }

    static GstBuffer *new_frame() { return gst_buffer_new_allocate(nullptr, 32, nullptr); }

    static GstBuffer *new_numbered_frame(guint64 number)
    {
        GstBuffer *frame = new_frame();
        GST_BUFFER_OFFSET(frame) = number;
        GST_BUFFER_OFFSET_END(frame) = number + 1;
        return frame;
    }

    GstFocusInfo push(GstBuffer *frame)
    {
        GstFocusInfo focus;
        gst_focus_info_init(&focus);
        g_autoptr(GstBuffer) out = gst_harness_push_and_pull(harness_, frame);
        const GstFocusMeta *meta = out ? gst_buffer_get_focus_meta(out) : nullptr;
        EXPECT_NE(meta, nullptr);
        if (meta)
            gst_focus_meta_get_focus(meta, &focus);
        return focus;
    }

    guint64 count(GstBuffer *frame)
    {
        const GstFocusInfo focus = push(frame);
        return focus.sweep * focus.planes + focus.plane;
    }

    bool warned()
    {
        g_autoptr(GstMessage) message = gst_bus_pop_filtered(bus_, GST_MESSAGE_WARNING);
        return message != nullptr;
    }

    GstHarness *harness_ = nullptr;
    GstBus *bus_ = gst_bus_new();
};

} // namespace

TEST_F(Tag, frames_cycle_through_the_planes)
{
    start();
    for (guint64 i = 0; i < 10; i++) {
        const GstFocusInfo focus = push(new_frame());
        EXPECT_EQ(focus.sweep, i / 4);
        EXPECT_EQ(focus.plane, i % 4);
        EXPECT_EQ(focus.planes, 4U);
        EXPECT_DOUBLE_EQ(focus.power, 3.0 - focus.plane);
        EXPECT_EQ(focus.code, -1);
        EXPECT_EQ(focus.frame_id, i);
        EXPECT_EQ(focus.exposure, GST_CLOCK_TIME_NONE);
    }
    EXPECT_FALSE(warned());
}

TEST_F(Tag, powers_that_nobody_said_are_not_known)
{
    start("lenssweeptag planes=4");
    for (guint i = 0; i < 4; i++)
        EXPECT_TRUE(std::isnan(push(new_frame()).power));
}

TEST_F(Tag, a_sweep_to_infinity_is_known_by_its_near_end)
{
    start("lenssweeptag planes=4 near=3");
    EXPECT_DOUBLE_EQ(push(new_frame()).power, 3.0);
    EXPECT_DOUBLE_EQ(push(new_frame()).power, 2.0);
}

TEST_F(Tag, powers_can_be_given_one_by_one)
{
    start("lenssweeptag powers=\"<4.0,1.0,0.5>\"");
    EXPECT_DOUBLE_EQ(push(new_frame()).power, 4.0);
    EXPECT_DOUBLE_EQ(push(new_frame()).power, 1.0);
    const GstFocusInfo last = push(new_frame());
    EXPECT_DOUBLE_EQ(last.power, 0.5);
    EXPECT_EQ(last.planes, 3U);
}

TEST_F(Tag, a_stage_stands_where_its_positions_say)
{
    start("lenssweeptag positions=\"<10.0,7.5,-1.25>\"");
    for (const double position : {10.0, 7.5, -1.25, 10.0}) {
        const GstFocusInfo focus = push(new_frame());
        EXPECT_DOUBLE_EQ(focus.position_um, position);
        EXPECT_EQ(focus.planes, 3U);
        EXPECT_TRUE(std::isnan(focus.power));
    }
}

TEST_F(Tag, a_stage_moves_by_the_step)
{
    start("lenssweeptag planes=4 step-um=-2.5");
    for (const double position : {0.0, -2.5, -5.0, -7.5, 0.0})
        EXPECT_DOUBLE_EQ(push(new_frame()).position_um, position);
}

TEST_F(Tag, positions_that_nobody_said_are_not_known)
{
    start();
    EXPECT_TRUE(std::isnan(push(new_frame()).position_um));
}

TEST_F(Tag, a_calibration_knows_better_where_planes_are)
{
    const std::string file = testing::TempDir() + "focus" + std::to_string(getpid()) + ".yml";
    g_file_set_contents(file.c_str(),
                        "%YAML:1.0\n---\nfocus:\n   vergences: [ 3., 1.9, 1.2 ]\n   field: [ 0., 0., 0. ]\n",
                        -1, nullptr);
    start(("lenssweeptag planes=3 near=5 far=1 calibration=" + file).c_str());
    for (const double power : {3.0, 1.9, 1.2, 3.0})
        EXPECT_DOUBLE_EQ(push(new_frame()).power, power);
    Pipeline other("videotestsrc ! lenssweeptag planes=4 calibration=" + file + " ! fakesink");
    EXPECT_NE(other.run().find("3 planes and the sweep 4"), std::string::npos);
    g_unlink(file.c_str());
}

TEST_F(Tag, pixels_are_not_copied_even_of_a_buffer_of_others)
{
    start();
    GstBuffer *frame = new_frame();
    g_autoptr(GstBuffer) kept = gst_buffer_ref(frame);
    g_autoptr(GstBuffer) out = gst_harness_push_and_pull(harness_, frame);
    EXPECT_NE(out, kept);
    EXPECT_EQ(gst_buffer_peek_memory(out, 0), gst_buffer_peek_memory(kept, 0));
    EXPECT_EQ(gst_buffer_get_focus_meta(kept), nullptr);
}

TEST_F(Tag, an_older_label_is_replaced)
{
    start();
    GstBuffer *frame = new_frame();
    GstFocusInfo old;
    gst_focus_info_init(&old);
    old.sweep = 77;
    gst_buffer_add_focus_meta(frame, &old);
    g_autoptr(GstBuffer) out = gst_harness_push_and_pull(harness_, frame);
    EXPECT_EQ(gst_buffer_get_n_meta(out, GST_FOCUS_META_API_TYPE), 1U);
    EXPECT_EQ(gst_buffer_get_focus_meta(out)->sweep, 0U);
}

TEST_F(Tag, a_lost_frame_leaves_its_plane_out)
{
    start();
    EXPECT_EQ(count(new_numbered_frame(11)), 0U);
    EXPECT_EQ(count(new_numbered_frame(12)), 1U);
    const GstFocusInfo focus = push(new_numbered_frame(14));
    EXPECT_EQ(focus.plane, 3U);
    EXPECT_EQ(focus.frame_id, 14U);
    EXPECT_FALSE(warned());
}

TEST_F(Tag, a_gap_is_placed_by_its_time)
{
    start();
    for (const guint64 frame : {0U, 1U, 6U}) {
        GstBuffer *buffer = new_frame();
        GST_BUFFER_PTS(buffer) = frame * GST_SECOND / 100 + (frame == 6 ? 2 * GST_MSECOND : 0);
        if (frame == 6)
            GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_DISCONT);
        EXPECT_EQ(count(buffer), frame);
    }
    EXPECT_FALSE(warned());
}

TEST_F(Tag, a_guess_is_said_aloud)
{
    start();
    count(new_frame());
    GstBuffer *frame = new_frame();
    GST_BUFFER_FLAG_SET(frame, GST_BUFFER_FLAG_DISCONT);
    EXPECT_EQ(count(frame), 4U);
    EXPECT_TRUE(warned());
}

TEST_F(Tag, after_a_flush_a_new_sweep_begins)
{
    start();
    count(new_frame());
    EXPECT_EQ(count(new_frame()), 1U);
    gst_harness_push_event(harness_, gst_event_new_flush_start());
    gst_harness_push_event(harness_, gst_event_new_flush_stop(TRUE));
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_harness_push_event(harness_, gst_event_new_segment(&segment));
    EXPECT_EQ(count(new_frame()), 4U);
    EXPECT_FALSE(warned());
}

TEST_F(Tag, bayer_pictures_pass)
{
    start("lenssweeptag planes=4", "video/x-bayer,format=rggb,width=8,height=4,framerate=100/1");
    EXPECT_EQ(count(new_frame()), 0U);
}

TEST(TagErrors, rising_powers_are_refused_with_what_to_do)
{
    Pipeline pipeline("videotestsrc num-buffers=3 ! lenssweeptag near=0 far=2 ! fakesink");
    const std::string error = pipeline.run();
    EXPECT_NE(error.find("near is greater than far"), std::string::npos) << error;
}

TEST(TagErrors, values_out_of_range_are_named_with_the_range)
{
    for (const auto &[properties, text] :
         {std::pair("planes=65", "planes=65 is out of range: 2 to 64"),
          std::pair("near=5000 far=1", "near=5000 is out of range: -100 to 1000"),
          std::pair("settle-frames=5000", "settle-frames=5000 is out of range")}) {
        Pipeline pipeline(std::string("videotestsrc num-buffers=3 ! lenssweeptag ") + properties +
                          " ! fakesink");
        EXPECT_NE(pipeline.run().find(text), std::string::npos) << properties;
    }
}

TEST(TagErrors, what_a_mode_needs_is_told)
{
    const auto error_of = [](const std::string &properties) {
        Pipeline pipeline("videotestsrc num-buffers=3 ! lenssweeptag " + properties + " ! fakesink");
        return pipeline.run();
    };
    EXPECT_NE(error_of("mode=step").find("needs a lens"), std::string::npos);
    EXPECT_NE(error_of("mode=step lens=v4l2:/dev/video-none").find("cannot open the lens"),
              std::string::npos);
    EXPECT_NE(error_of("mode=step lens=max14574:/dev/i2c-none").find("i2c-dev"), std::string::npos);
    EXPECT_NE(error_of("mode=step lens=genicam:FocalPower").find("lenssweepsrc"), std::string::npos);
    EXPECT_NE(error_of("mode=step lens=webcam:/dev/video0").find("v4l2:/dev/video0"), std::string::npos);
    EXPECT_NE(error_of("mode=step lens=optotune:/dev/ttyACM-none").find("dialout"), std::string::npos);
    EXPECT_NE(error_of("mode=sync").find("sync-line"), std::string::npos);
    EXPECT_NE(error_of("positions=<1.0,3.0,2.0>").find("all rise or all fall"), std::string::npos);
    EXPECT_NE(error_of("positions=<1.0>").find("2 to 64 planes"), std::string::npos);
    EXPECT_NE(error_of("positions=<1.0,2.0> step-um=1").find("both set"), std::string::npos);
    EXPECT_NE(error_of("positions=<1.0,2.0> powers=<3.0,2.0,1.0>").find("2 planes and powers 3"),
              std::string::npos);
    EXPECT_NE(error_of("step-um=nan").find("step-um"), std::string::npos);
    EXPECT_NE(error_of("lens-profile=/no/lens.yaml").find("lens that is moved"), std::string::npos);
    EXPECT_NE(error_of("mode=sync sync-line=DFF-NO-SUCH-LINE").find("gpio"), std::string::npos);
}

TEST_F(Tag, stats_count_what_came_in)
{
    start();
    push(new_frame());
    push(new_frame());
    g_autoptr(GstElement) tag = gst_harness_find_element(harness_, "lenssweeptag");
    g_autoptr(GstStructure) stats = nullptr;
    g_object_get(tag, "stats", &stats, nullptr);
    guint64 frames = 0;
    guint64 labelled = 0;
    guint64 dropped = 0;
    EXPECT_TRUE(gst_structure_get(stats, "frames", G_TYPE_UINT64, &frames, "labelled", G_TYPE_UINT64,
                                  &labelled, "dropped", G_TYPE_UINT64, &dropped, nullptr));
    EXPECT_EQ(frames, 2U);
    EXPECT_EQ(labelled, 2U);
    EXPECT_EQ(dropped, 0U);
}

TEST(TagPipelines, bytes_without_times_pass_without_a_critical)
{
    static std::atomic<unsigned> criticals;
    criticals = 0;
    const guint handler = g_log_set_handler(
        "GStreamer", G_LOG_LEVEL_CRITICAL,
        [](const gchar *, GLogLevelFlags, const gchar *, gpointer) { criticals++; }, nullptr);
    g_autofree gchar *path = nullptr;
    close(g_file_open_tmp("dff-tag-XXXXXX", &path, nullptr));
    const std::string pixels(12 * 64 * 64, 'x');
    ASSERT_TRUE(g_file_set_contents(path, pixels.data(), static_cast<gssize>(pixels.size()), nullptr));
    EXPECT_EQ(Pipeline("filesrc blocksize=4096 location=" + std::string(path) +
                       " ! video/x-raw,format=GRAY8,width=64,height=64,framerate=30/1 ! lenssweeptag "
                       "planes=3 ! fakesink")
                  .run(),
              "");
    EXPECT_EQ(criticals, 0U);
    g_log_remove_handler("GStreamer", handler);
    g_remove(path);
}

TEST(TagPipelines, labels_survive_conversion_and_scaling)
{
    Pipeline pipeline("videotestsrc num-buffers=5 ! lenssweeptag planes=2 ! videoconvert ! videoscale ! "
                      "video/x-raw,format=RGB,width=100,height=100 ! appsink name=out sync=false");
    pipeline.set_state(GST_STATE_PLAYING);
    const auto samples = pipeline.pull_all("out");
    ASSERT_EQ(samples.size(), 5U);
    for (guint i = 0; i < 5; i++) {
        ASSERT_NE(focus_of(samples[i]), nullptr);
        EXPECT_EQ(focus_of(samples[i])->plane, i % 2);
    }
}

TEST(TagPipelines, the_documented_pipeline_runs)
{
    Pipeline pipeline(
        "videotestsrc num-buffers=60 ! lenssweeptag planes=10 near=4 far=0.5 ! fakesink silent=false");
    EXPECT_EQ(pipeline.run(), "");
}
