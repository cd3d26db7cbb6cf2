/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "support.h"

#include <array>
#include <gtest/gtest.h>
#include <unistd.h>

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

TEST(MuxErrors, a_property_out_of_range_is_named_with_the_range)
{
    const std::string text = error_of("videotestsrc num-buffers=1 ! focalstackmux planes=100 ! fakesink");
    EXPECT_NE(text.find("planes=100 is out of range: 0 to 64"), std::string::npos) << text;
}

class OtherCaps : public testing::TestWithParam<std::pair<const char *, const char *>> {};

TEST_P(OtherCaps, of_one_plane_are_an_error_that_names_both)
{
    const auto source = [](const std::string &caps) {
        return "videotestsrc num-buffers=40 ! capsfilter caps=\"video/x-raw,format=GRAY8" + caps + "\" ! ";
    };
    const std::string text = error_of((source(GetParam().first) + "m.sink_0  " + source(GetParam().second) +
                                       "m.sink_1  focalstackmux name=m ! fakesink")
                                          .c_str());
    for (const char *part : {"\"sink_0\" has video/x-raw", "\"sink_1\" has video/x-raw"})
        EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_NE(text.find("videoconvert"), std::string::npos) << text;
}

INSTANTIATE_TEST_SUITE_P(MuxErrors, OtherCaps,
                         testing::Values(std::pair(",width=64,height=64", ",width=128,height=64"),
                                         std::pair(",framerate=30/1", ",framerate=25/1"),
                                         std::pair(",colorimetry=bt709", ",colorimetry=bt601")));

TEST(MuxErrors, a_size_that_no_stack_has_is_told_with_the_limits)
{
    const std::string small =
        error_of("videotestsrc ! video/x-raw,format=GRAY8,width=32,height=48 ! identity ! "
                 "focalstackmux ! video/x-focal-stack,width=[64,16384],height=[64,16384] ! fakesink");
    EXPECT_NE(small.find("32x48"), std::string::npos) << small;
    EXPECT_NE(small.find("64x64 to 16384x16384"), std::string::npos) << small;
}

TEST(MuxErrors, a_size_that_comes_late_is_told_with_the_limits)
{
    const Owned<GstHarness> harness(gst_harness_new_parse("focalstackmux"));
    GstBus *bus = gst_bus_new();
    GstElement *mux = gst_harness_find_element(harness.get(), "focalstackmux");
    gst_element_set_bus(mux, bus);
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 17000, 64).c_str());
    const Owned<GstMessage> message(gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR));
    ASSERT_TRUE(message);
    g_autoptr(GError) error = nullptr;
    gst_message_parse_error(message.get(), &error, nullptr);
    EXPECT_STREQ(error->message, "Pictures of 17000x64 pixels cannot become stacks: 1x1 to 16384x16384 can.");
    gst_element_set_bus(mux, nullptr);
    gst_object_unref(mux);
    gst_object_unref(bus);
}

TEST(MuxErrors, a_scaler_is_still_told_the_size)
{
    const std::string source =
        "videotestsrc num-buffers=2 ! video/x-raw,format=GRAY8,width=32,height=48 ! videoscale ! ";
    EXPECT_EQ(
        error_of((source + "m.sink_0 " + source +
                  "m.sink_1 focalstackmux name=m ! video/x-focal-stack,width=[64,16384],height=[64,16384] ! "
                  "fakesink")
                     .c_str()),
        "");
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

TEST(MuxErrors, a_stack_larger_than_the_machine_is_told_with_bytes_before_it_is_allocated)
{
    if (static_cast<guint64>(sysconf(_SC_PHYS_PAGES)) * static_cast<guint64>(sysconf(_SC_PAGESIZE)) >> 35)
        GTEST_SKIP() << "a machine of 32 GiB takes the largest stack there is";
    const Owned<GstHarness> harness(gst_harness_new_parse("focalstackmux"));
    GstElement *mux = gst_harness_find_element(harness.get(), "focalstackmux");
    GstBus *bus = gst_bus_new();
    gst_element_set_bus(mux, bus);
    gst_harness_set_src_caps_str(harness.get(), frame_caps("RGBx", 8192, 8192).c_str());
    GstBuffer *frame = new_frame(video_info("RGBx", 32, 32), 0, 0, 64); /* what it holds is looked at later */
    EXPECT_EQ(gst_harness_push(harness.get(), frame), GST_FLOW_ERROR);
    const Owned<GstMessage> message(gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR));
    ASSERT_TRUE(message);
    g_autoptr(GError) error = nullptr;
    gst_message_parse_error(message.get(), &error, nullptr);
    EXPECT_TRUE(g_error_matches(error, GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_NO_SPACE_LEFT));
    for (const char *word : {"17179869184 bytes", "64 planes of 8192x8192 RGBx", "lower planes"})
        EXPECT_NE(std::string(error->message).find(word), std::string::npos) << error->message;
    gst_element_set_bus(mux, nullptr);
    gst_object_unref(bus);
    gst_object_unref(mux);
}

TEST(MuxErrors, frames_whose_layout_lies_are_left_out)
{
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const auto lies = std::to_array<void (*)(GstVideoMeta *)>({
        [](GstVideoMeta *meta) { meta->stride[0] = G_MAXINT; },
        [](GstVideoMeta *meta) { meta->stride[0] = 33; },
        [](GstVideoMeta *meta) { meta->stride[0] = -32; },
        [](GstVideoMeta *meta) { meta->offset[0] = 1; },
        [](GstVideoMeta *meta) { meta->offset[0] = G_MAXSIZE; },
        [](GstVideoMeta *meta) { meta->width = 64; },
        [](GstVideoMeta *meta) { meta->height = 8; },
    });
    const GLogLevelFlags fatal =
        g_log_set_always_fatal(static_cast<GLogLevelFlags>(G_LOG_FATAL_MASK | G_LOG_LEVEL_CRITICAL));
    const Owned<GstHarness> harness(gst_harness_new_parse("focalstackmux"));
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    for (size_t i = 0; i < lies.size(); i++) {
        GstBuffer *frame = new_frame(info, 0, 0, 2);
        lies[i](gst_buffer_add_video_meta(frame, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_GRAY8, 32, 16));
        EXPECT_EQ(gst_harness_push(harness.get(), frame), GST_FLOW_OK);
    }
    GstElement *mux = gst_harness_find_element(harness.get(), "focalstackmux");
    EXPECT_EQ(count_of(mux, "damaged"), lies.size());
    gst_object_unref(mux);
    g_log_set_always_fatal(fatal);
}

TEST(MuxErrors, planes_other_than_the_frames_say_is_an_error)
{
    const GstVideoInfo info = video_info("GRAY8", 32, 16);
    const Owned<GstHarness> harness(gst_harness_new_parse("focalstackmux planes=4"));
    gst_harness_set_src_caps_str(harness.get(), frame_caps("GRAY8", 32, 16).c_str());
    EXPECT_EQ(gst_harness_push(harness.get(), new_frame(info, 0, 0, 3)), GST_FLOW_ERROR);
}
