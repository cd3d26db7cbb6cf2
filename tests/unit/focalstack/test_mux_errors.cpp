/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "support.h"

#include <gtest/gtest.h>

namespace {

/* The text of the error a pipeline ends with, or an empty one. */
std::string error_of(const char *description)
{
    GstElement *pipeline = gst_parse_launch(description, nullptr);
    GstBus *bus = gst_element_get_bus(pipeline);
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    const Owned<GstMessage> message(gst_bus_timed_pop_filtered(
        bus, 10 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS)));
    std::string text = message ? "" : "nothing happened";
    if (message && GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_ERROR) {
        g_autoptr(GError) error = nullptr;
        g_autofree gchar *details = nullptr;
        gst_message_parse_error(message.get(), &error, &details);
        text = std::string(error->message) + " " + details;
    }
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(bus);
    gst_object_unref(pipeline);
    return text;
}

} // namespace

TEST(MuxErrors, frames_without_meta_say_what_to_put_before)
{
    EXPECT_NE(error_of("videotestsrc num-buffers=9 ! focalstackmux ! fakesink").find("lenssweeptag"),
              std::string::npos);
}

TEST(MuxErrors, both_pads_linked_is_an_error_that_names_them)
{
    const std::string text =
        error_of("videotestsrc ! focalstackmux name=m ! fakesink  videotestsrc ! m.sink_0");
    EXPECT_NE(text.find("Both the pad \"sink\""), std::string::npos) << text;
}

TEST(MuxErrors, a_pad_left_out_is_an_error_that_names_it)
{
    const std::string text =
        error_of("focalstackmux name=m ! fakesink  videotestsrc ! m.sink_0  videotestsrc ! m.sink_2");
    EXPECT_NE(text.find("\"sink_1\" is not linked"), std::string::npos) << text;
}

TEST(MuxErrors, a_single_plane_is_an_error)
{
    const std::string text = error_of("focalstackmux name=m ! fakesink  videotestsrc ! m.sink_0");
    EXPECT_NE(text.find("2 to 64 planes, not 1"), std::string::npos) << text;
}

TEST(MuxErrors, formats_that_make_no_stacks_do_not_link)
{
    GstElement *pipeline =
        gst_parse_launch("videotestsrc ! video/x-raw,format=v210 ! focalstackmux ! fakesink", nullptr);
    EXPECT_EQ(gst_element_set_state(pipeline, GST_STATE_PLAYING), GST_STATE_CHANGE_ASYNC);
    GstBus *bus = gst_element_get_bus(pipeline);
    const Owned<GstMessage> error(gst_bus_timed_pop_filtered(bus, 10 * GST_SECOND, GST_MESSAGE_ERROR));
    EXPECT_TRUE(error);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(bus);
    gst_object_unref(pipeline);
}

TEST(MuxErrors, planes_other_than_the_frames_say_is_an_error)
{
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const Owned<GstHarness> harness(gst_harness_new_parse("focalstackmux planes=4"));
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    EXPECT_EQ(gst_harness_push(harness.get(), new_frame(info, 0, 0, 3)), GST_FLOW_ERROR);
}
