/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "late_lens_source.h"
#include "support.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <thread>

namespace {

/* What came of a sweep of some frames. */
struct Tally {
    guint64 labelled = 0;
    guint64 wrong = 0; /* the lens was further from the label than a quarter of a plane */
    std::string warnings;
    std::string error;
};

struct Sweep {
    unsigned planes = 5;
    double near = 8;
    double far = 0;

    std::string properties() const
    {
        return " planes=" + std::to_string(planes) + " near=" + std::to_string(near) +
               " far=" + std::to_string(far) + " ";
    }
    double step() const { return (near - far) / (planes - 1); }
};

struct Watched {
    Tally tally;
    double tolerance;
};

void look(GstElement *, GstBuffer *buffer, GstPad *, gpointer data)
{
    auto &watched = *static_cast<Watched *>(data);
    watched.tally.labelled++;
    const GstFocusMeta *focus = gst_buffer_get_focus_meta(buffer);
    if (!focus || !(std::abs(focus->power - true_position(buffer)) <= watched.tolerance))
        watched.tally.wrong++;
}

void take_messages(GstElement *pipeline, Tally &tally)
{
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline);
    for (;;) {
        g_autoptr(GstMessage) message = gst_bus_timed_pop_filtered(
            bus, patience,
            static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR | GST_MESSAGE_WARNING));
        if (!message || GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS)
            return;
        g_autoptr(GError) error = nullptr;
        if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
            gst_message_parse_error(message, &error, nullptr);
            tally.error = error->message;
            return;
        }
        gst_message_parse_warning(message, &error, nullptr);
        tally.warnings += error->message;
    }
}

Tally run(const std::string &source, const std::string &tag, const Sweep &sweep = {})
{
    register_late_lens_source();
    Pipeline pipeline("latelenssrc name=cam " + source +
                      " ! lenssweeptag name=tag lens=element:cam.lens-position mode=step" +
                      sweep.properties() + tag + " ! fakesink name=out signal-handoffs=true");
    Watched watched{{}, sweep.step() / 4};
    g_signal_connect(pipeline.element("out"), "handoff", G_CALLBACK(look), &watched);
    pipeline.set_state(GST_STATE_PLAYING);
    take_messages(pipeline.get(), watched.tally);
    pipeline.set_state(GST_STATE_NULL);
    return watched.tally;
}

std::string error_of(const std::string &source, const std::string &tag)
{
    register_late_lens_source();
    Pipeline pipeline(source + " ! lenssweeptag mode=step " + tag + " ! fakesink");
    return pipeline.run();
}

} // namespace

TEST(ElementLens, no_label_is_wrong_whatever_the_delay_where_the_camera_says_where_its_lens_is)
{
    for (unsigned delay = 0; delay <= 5; delay++) {
        const Tally tally = run("num-buffers=10000 delay=" + std::to_string(delay), "settle-frames=0");
        EXPECT_EQ(tally.error, "");
        EXPECT_EQ(tally.warnings, "") << "delay " << delay;
        EXPECT_EQ(tally.wrong, 0U) << "delay " << delay;
        EXPECT_GT(tally.labelled, 10000 / (delay + 2)) << "delay " << delay;
    }
}

/* The whole way back, 8 dioptres, is 64 times the tolerated fault after 3.0 time constants. */
TEST(ElementLens, no_label_is_wrong_of_a_lens_that_takes_time_when_settle_frames_covers_it)
{
    for (unsigned delay : {0U, 3U, 5U}) {
        const Tally tally =
            run("num-buffers=10000 lag=1.5 delay=" + std::to_string(delay), "settle-frames=4");
        EXPECT_EQ(tally.error, "");
        EXPECT_EQ(tally.warnings, "") << "delay " << delay;
        EXPECT_EQ(tally.wrong, 0U) << "delay " << delay;
        EXPECT_GT(tally.labelled, 10000 / (delay + 7)) << "delay " << delay;
    }
}

TEST(ElementLens, a_camera_that_only_repeats_what_was_set_needs_settle_frames_for_its_delay)
{
    const Tally right = run("num-buffers=10000 echo=true delay=3", "settle-frames=3");
    EXPECT_EQ(right.wrong, 0U);
    EXPECT_EQ(right.warnings, "");
    const Tally wrong = run("num-buffers=3000 echo=true delay=3", "settle-frames=1");
    EXPECT_GT(wrong.wrong, 0U);
    EXPECT_NE(wrong.warnings.find("settle-frames"), std::string::npos) << wrong.warnings;
}

TEST(ElementLens, sharpness_tells_when_settle_frames_is_too_small)
{
    for (unsigned delay = 0; delay <= 5; delay++) {
        const Tally tally = run("num-buffers=3000 lag=1.5 delay=" + std::to_string(delay), "settle-frames=0");
        EXPECT_GT(tally.wrong, 0U);
        EXPECT_NE(tally.warnings.find("settle-frames to more than 0"), std::string::npos)
            << "delay " << delay << ": " << tally.warnings;
    }
}

TEST(ElementLens, frames_with_times_are_counted_from_the_one_that_has_the_plane)
{
    const Tally tally = run("live=true do-timestamp=true num-buffers=400 delay=3 ! "
                            "video/x-raw,framerate=200/1 ! identity sleep-time=5000",
                            "settle-frames=0");
    EXPECT_EQ(tally.error, "");
    EXPECT_EQ(tally.wrong, 0U);
    EXPECT_GT(tally.labelled, 40U);
}

TEST(ElementLens, autofocus_is_given_back)
{
    register_late_lens_source();
    Pipeline pipeline("latelenssrc name=cam num-buffers=30 ! lenssweeptag mode=step "
                      "lens=element:cam.lens-position near=4 far=1 ! fakesink");
    g_autofree gchar *before = nullptr;
    EXPECT_EQ(pipeline.run(), "");
    gint mode = -1;
    g_object_get(pipeline.element("cam"), "af-mode", &mode, nullptr);
    EXPECT_EQ(mode, 1) << "manual as long as the sweep lasts";
    pipeline.set_state(GST_STATE_NULL);
    g_object_get(pipeline.element("cam"), "af-mode", &mode, nullptr);
    EXPECT_EQ(mode, 0);
}

TEST(ElementLens, powers_out_of_range_are_named_with_the_range)
{
    const std::string error =
        error_of("latelenssrc name=cam", "lens=element:cam.lens-position near=12 far=0");
    EXPECT_NE(error.find("cam.lens-position is 0 to 10, not 12"), std::string::npos) << error;
}

TEST(ElementLens, what_is_missing_is_named)
{
    const std::string cam = "latelenssrc name=cam";
    EXPECT_NE(error_of(cam, "lens=element:eye.lens-position").find("called eye"), std::string::npos);
    EXPECT_NE(error_of(cam, "lens=element:cam.focus").find("no property focus"), std::string::npos);
    EXPECT_NE(error_of(cam, "lens=element:cam.af-mode").find("no number"), std::string::npos);
    EXPECT_NE(error_of(cam, "lens=element:cam.delay").find("set and read"), std::string::npos);
    EXPECT_NE(error_of(cam, "lens=element:cam").find("names no property"), std::string::npos);
}

TEST(ElementLens, a_lens_that_never_arrives_is_an_error)
{
    register_late_lens_source();
    Pipeline pipeline("latelenssrc name=cam ! lenssweeptag mode=step lens=element:cam.lens-position near=4 "
                      "far=1 ! fakesink name=out signal-handoffs=true");
    const auto stop_obeying = +[](GstElement *, GstBuffer *, GstPad *, gpointer cam) {
        gst_util_set_object_arg(G_OBJECT(cam), "af-mode", "auto");
    };
    g_signal_connect(pipeline.element("out"), "handoff", G_CALLBACK(stop_obeying), pipeline.element("cam"));
    const std::string error = pipeline.run();
    EXPECT_NE(error.find("long after"), std::string::npos) << error;
}

/* Unplugged in mid-sweep, and back again. The element with the lens is not the source here. */
TEST(ElementLens, an_element_that_leaves_the_pipeline_is_an_error_and_may_come_back)
{
    register_late_lens_source();
    Pipeline pipeline(
        "videotestsrc ! video/x-raw,width=64,height=64 ! lenssweeptag mode=step "
        "lens=element:lens.lens-position near=4 far=1 ! fakesink name=out signal-handoffs=true");
    GstElement *lens = gst_element_factory_make("latelenssrc", "lens");
    gst_object_ref_sink(lens);
    g_object_set(lens, "echo", TRUE, nullptr);
    gst_element_set_locked_state(lens, TRUE);
    gst_bin_add(GST_BIN(pipeline.get()), lens);
    const auto leave = +[](GstElement *, GstBuffer *, GstPad *, gpointer element) {
        g_autoptr(GstObject) parent = gst_object_get_parent(GST_OBJECT(element));
        if (parent)
            gst_bin_remove(GST_BIN(parent), GST_ELEMENT(element));
    };
    const gulong handler = g_signal_connect(pipeline.element("out"), "handoff", G_CALLBACK(leave), lens);
    EXPECT_NE(pipeline.run().find("in the pipeline no more"), std::string::npos);
    g_signal_handler_disconnect(pipeline.element("out"), handler);
    pipeline.set_state(GST_STATE_NULL);
    EXPECT_NE(pipeline.run().find("called lens"), std::string::npos);
    pipeline.set_state(GST_STATE_NULL);

    gst_bin_add(GST_BIN(pipeline.get()), lens);
    g_object_set(pipeline.element("out"), "num-buffers", 20, nullptr);
    EXPECT_EQ(pipeline.run(), "");
    pipeline.set_state(GST_STATE_NULL);
    gst_object_unref(lens);
}

TEST(ElementLens, other_units_come_by_a_profile)
{
    register_late_lens_source();
    g_autofree gchar *folder = g_dir_make_tmp("dff-points-XXXXXX", nullptr);
    const std::string path = std::string(folder) + "/points.yaml";
    std::ofstream(path) << "%YAML:1.0\n---\nlens: \"turned\"\nvergence: [ 0, 1, 4 ]\nposition: [ 9, 5, 2 ]\n";
    Pipeline pipeline(
        "latelenssrc name=cam num-buffers=40 delay=1 ! lenssweeptag mode=step lens-profile=" + path +
        " lens=element:cam.lens-position planes=3 near=4 far=0 settle-frames=0 ! appsink name=out "
        "sync=false");
    pipeline.set_state(GST_STATE_PLAYING);
    const auto samples = pipeline.pull_all("out");
    std::filesystem::remove_all(folder);
    ASSERT_GE(samples.size(), 6U);
    const double positions[] = {2, 5 - 1.0, 9}; /* of 4, 2 and 0 dioptres */
    for (const auto &sample : samples) {
        const GstFocusMeta *focus = focus_of(sample);
        EXPECT_NEAR(focus->power, 4 - 2.0 * focus->plane, 1e-9);
        EXPECT_NEAR(true_position(gst_sample_get_buffer(sample.get())), positions[focus->plane], 1e-6);
    }
}

TEST(ElementLens, two_hundred_starts_leave_nothing_behind)
{
    register_late_lens_source();
    Pipeline pipeline(
        "latelenssrc name=cam ! lenssweeptag mode=step lens=element:cam.lens-position near=4 far=1 "
        "! fakesink");
    GstElement *cam = pipeline.element("cam");
    const guint references = GST_OBJECT_REFCOUNT_VALUE(cam);
    for (int cycle = 0; cycle < 200; cycle++) {
        ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
        gst_element_get_state(pipeline.get(), nullptr, nullptr, patience);
        ASSERT_EQ(pipeline.set_state(GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
    }
    EXPECT_EQ(GST_OBJECT_REFCOUNT_VALUE(cam), references);
}
