/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_pipeline.h"

#include <cmath>
#include <gst/check/gstharness.h>
#include <gtest/gtest.h>
#include <numbers>

using dff::run;
using dff::TestPipeline;

namespace {

/* Two pictures and depth maps into the element `l`, whose properties and what follows it come after this. */
std::string scene(const std::string &format = "RGB", int depth_width = 96)
{
    return "videotestsrc num-buffers=2 ! video/x-raw,framerate=26/1,width=96,height=64,format=" + format +
           " ! queue ! l.color  videotestsrc num-buffers=2 pattern=gradient ! "
           "video/x-raw,framerate=26/1,height=64,format=GRAY16_LE,width=" +
           std::to_string(depth_width) + " ! queue ! l.depth  lightfieldcompose name=l ";
}

GstVideoInfo info_of(GstSample *sample)
{
    GstVideoInfo info;
    gst_video_info_from_caps(&info, gst_sample_get_caps(sample));
    return info;
}

/* The element alone, with both pads fed by hand: colour by a harness, depth by a pad that is linked before
 * the harness starts the element. */
class Harness {
public:
    Harness() : element_((gst_init(nullptr, nullptr), gst_element_factory_make("lightfieldcompose", nullptr)))
    {
        gst_util_set_object_arg(G_OBJECT(element_), "layout", "views");
        depth_ = gst_pad_new("depth", GST_PAD_SRC);
        gst_pad_set_active(depth_, TRUE);
        g_autoptr(GstPad) sink = gst_element_get_static_pad(element_, "depth");
        gst_pad_link(depth_, sink);
        color_ = gst_harness_new_with_element(element_, "color", "src");
        gst_harness_set_src_caps_str(color_, "video/x-raw,format=RGB,width=32,height=16,framerate=10/1");
        g_autoptr(GstCaps) caps =
            gst_caps_from_string("video/x-raw,format=GRAY16_LE,width=32,height=16,framerate=10/1");
        GstSegment segment;
        gst_segment_init(&segment, GST_FORMAT_TIME);
        gst_pad_push_event(depth_, gst_event_new_stream_start("depth"));
        gst_pad_push_event(depth_, gst_event_new_caps(caps));
        gst_pad_push_event(depth_, gst_event_new_segment(&segment));
    }

    ~Harness()
    {
        gst_harness_teardown(color_);
        gst_pad_set_active(depth_, FALSE);
        gst_object_unref(depth_);
        gst_object_unref(element_);
    }

    Harness(const Harness &) = delete;
    Harness &operator=(const Harness &) = delete;

    GstElement *element() const { return element_; }
    GstHarness *color() const { return color_; }

    void push_color(GstClockTime pts, guint8 value = 0) const
    {
        gst_harness_push(color_, make_buffer(32 * 3 * 16, pts, value));
    }

    void push_depth(GstClockTime pts) const { gst_pad_push(depth_, make_buffer(32 * 2 * 16, pts, 1)); }
    void end_of_depth() const { gst_pad_push_event(depth_, gst_event_new_eos()); }

    guint64 count(const char *field) const
    {
        GstStructure *stats = nullptr;
        guint64 value = 0;
        g_object_get(element_, "stats", &stats, nullptr);
        gst_structure_get_uint64(stats, field, &value);
        gst_structure_free(stats);
        return value;
    }

private:
    static GstBuffer *make_buffer(gsize size, GstClockTime pts, guint8 value)
    {
        GstBuffer *buffer = gst_buffer_new_allocate(nullptr, size, nullptr);
        gst_buffer_memset(buffer, 0, value, size);
        GST_BUFFER_PTS(buffer) = pts;
        if (GST_CLOCK_TIME_IS_VALID(pts))
            GST_BUFFER_DURATION(buffer) = GST_SECOND / 10;
        return buffer;
    }

    GstElement *element_;
    GstPad *depth_;
    GstHarness *color_;
};

} // namespace

TEST(LightFieldCompose, every_layout_has_its_size)
{
    const std::vector<std::tuple<std::string, int, int>> layouts{
        {"layout=quilt", 8 * 96, 6 * 64},
        {"layout=quilt columns=3 rows=2 view-aspect=1", 3 * 64, 2 * 64},
        {"preset=looking-glass-portrait ! video/x-raw,width=400,height=300", 400, 300},
        {"preset=looking-glass-portrait", 3360, 3360},
        {"layout=rgbd", 2 * 96, 64},
        {"layout=rgbd depth-side=left", 2 * 96, 64},
        {"layout=rgbd depth-side=below", 96, 2 * 64},
        {"layout=rgbd depth-side=above", 96, 2 * 64},
        {"layout=views", 2 * 96, 64},
        {"layout=views columns=5", 5 * 96, 64},
        {"layout=views columns=1 rows=2", 96, 2 * 64},
        {"layout=elemental", 96, 64},
        {"layout=elemental grid=hex rotation=20 ! video/x-raw,width=200,height=100", 200, 100},
    };
    for (const auto &[layout, width, height] : layouts) {
        TestPipeline pipeline(scene() + layout + " ! appsink name=out sync=false");
        pipeline.play();
        g_autoptr(GstSample) sample = pipeline.pull("out");
        ASSERT_NE(sample, nullptr) << layout;
        const GstVideoInfo info = info_of(sample);
        EXPECT_EQ(GST_VIDEO_INFO_WIDTH(&info), width) << layout;
        EXPECT_EQ(GST_VIDEO_INFO_HEIGHT(&info), height) << layout;
    }
}

TEST(LightFieldCompose, two_views_say_how_they_are_packed)
{
    const auto full = GST_VIDEO_MULTIVIEW_FLAGS_NONE, half = GST_VIDEO_MULTIVIEW_FLAGS_HALF_ASPECT;
    const std::vector<std::tuple<std::string, GstVideoMultiviewMode, GstVideoMultiviewFlags>> layouts{
        {"layout=views", GST_VIDEO_MULTIVIEW_MODE_SIDE_BY_SIDE, full},
        {"layout=views ! video/x-raw,multiview-mode=side-by-side", GST_VIDEO_MULTIVIEW_MODE_SIDE_BY_SIDE,
         full},
        {"layout=views ! video/x-raw,width=96,height=64", GST_VIDEO_MULTIVIEW_MODE_SIDE_BY_SIDE, half},
        {"layout=views columns=1 rows=2", GST_VIDEO_MULTIVIEW_MODE_TOP_BOTTOM, full},
        {"layout=views columns=1 rows=2 ! video/x-raw,width=96,height=64",
         GST_VIDEO_MULTIVIEW_MODE_TOP_BOTTOM, half},
        {"layout=views columns=5", GST_VIDEO_MULTIVIEW_MODE_NONE, full},
        {"layout=quilt columns=2 rows=1", GST_VIDEO_MULTIVIEW_MODE_NONE, full},
    };
    for (const auto &[layout, mode, flags] : layouts) {
        TestPipeline pipeline(scene() + layout + " ! appsink name=out sync=false");
        pipeline.play();
        g_autoptr(GstSample) sample = pipeline.pull("out");
        ASSERT_NE(sample, nullptr) << layout;
        const GstVideoInfo info = info_of(sample);
        EXPECT_EQ(GST_VIDEO_INFO_MULTIVIEW_MODE(&info), mode) << layout;
        EXPECT_EQ(GST_VIDEO_INFO_MULTIVIEW_FLAGS(&info), flags) << layout;
    }
}

TEST(LightFieldCompose, every_format_becomes_every_other)
{
    for (const char *format : {"RGBx", "BGRx", "RGB", "BGR", "I420", "NV12"})
        for (const char *wanted : {"RGBx", "BGRx", "RGB", "BGR"})
            for (const char *layout : {"views", "rgbd"}) {
                const dff::Outcome outcome = run(scene(format) + "layout=" + layout +
                                                 " ! video/x-raw,format=" + wanted + " ! fakesink");
                EXPECT_TRUE(outcome.end_of_stream) << format << " to " << wanted << ": " << outcome.error;
            }
}

TEST(LightFieldCompose, colours_keep_their_own_format_where_anything_goes)
{
    for (const auto &[format, expected] :
         {std::pair{"BGR", "BGR"}, std::pair{"BGRx", "BGRx"}, std::pair{"NV12", "RGBx"}}) {
        TestPipeline pipeline(scene(format) + "layout=views ! appsink name=out sync=false");
        pipeline.play();
        g_autoptr(GstSample) sample = pipeline.pull("out");
        ASSERT_NE(sample, nullptr) << format;
        const GstVideoInfo info = info_of(sample);
        EXPECT_STREQ(GST_VIDEO_INFO_NAME(&info), expected);
    }
}

/* Colours as converted are the same as colours converted before. */
TEST(LightFieldCompose, i420_and_nv12_show_the_same_colours)
{
    for (const char *format : {"I420", "NV12"})
        for (const char *layout : {"rgbd", "views", "quilt columns=2 rows=2"}) {
            std::vector<std::vector<guint8>> pictures;
            for (const char *before : {"", " ! videoconvert dither=none ! video/x-raw,format=RGBx"}) {
                std::string description = scene(format);
                const std::string queue = " ! queue ! l.color";
                description.insert(description.find(queue), before);
                TestPipeline pipeline(description + "layout=" + layout +
                                      " ! video/x-raw,format=RGBx ! appsink name=out sync=false");
                pipeline.play();
                g_autoptr(GstSample) sample = pipeline.pull("out");
                ASSERT_NE(sample, nullptr) << format << " " << layout;
                GstBuffer *buffer = gst_sample_get_buffer(sample);
                pictures.emplace_back(gst_buffer_get_size(buffer));
                gst_buffer_extract(buffer, 0, pictures.back().data(), pictures.back().size());
            }
            EXPECT_EQ(pictures[0], pictures[1]) << format << " " << layout;
        }
}

TEST(LightFieldCompose, sizes_outside_the_limits_are_told_with_the_limit)
{
    const auto error_of = [](const std::string &color_size, const std::string &rest) {
        return run("videotestsrc num-buffers=1 ! video/x-raw,framerate=26/1,format=RGB," + color_size +
                   " ! queue ! l.color  videotestsrc num-buffers=1 ! video/x-raw,framerate=26/1,"
                   "format=GRAY16_LE," +
                   color_size + " ! queue ! l.depth  lightfieldcompose name=l " + rest + " ! fakesink")
            .error;
    };
    const std::string small = "width=32,height=16", wide = "width=8200,height=16",
                      high = "width=16,height=8193";
    EXPECT_NE(error_of(wide, "layout=views").find("8200x16 pixels, and the limit is 8192x8192"),
              std::string::npos);
    EXPECT_NE(error_of(high, "layout=rgbd").find("16x8193 pixels, and the limit is 8192x8192"),
              std::string::npos);
    for (const char *layout : {"quilt", "views", "elemental"})
        EXPECT_NE(error_of(small, "layout=" + std::string(layout) + " ! video/x-raw,width=20000,height=16")
                      .find("20000x16 pixels, and the limit is 16384x16384"),
                  std::string::npos)
            << layout;
    EXPECT_NE(error_of(small, "layout=rgbd ! video/x-raw,width=32").find("pictures of 64x16 pixels"),
              std::string::npos);
    EXPECT_NE(error_of(small, "layout=elemental gap=1e-300").find("gap is 0.000000 pixels and must be 0, or"),
              std::string::npos);
}

TEST(LightFieldCompose, the_suffix_tells_players_the_layout_of_the_quilt)
{
    TestPipeline pipeline(scene() +
                          "preset=looking-glass-portrait ! video/x-raw,width=480,height=480 ! appsink "
                          "name=out sync=false");
    pipeline.play();
    g_autoptr(GstSample) sample = pipeline.pull("out");
    g_autofree gchar *suffix = nullptr;
    g_object_get(pipeline.element("l"), "file-suffix", &suffix, nullptr);
    EXPECT_STREQ(suffix, "_qs8x6a0.75");
}

TEST(LightFieldCompose, pictures_go_with_the_depth_of_their_time)
{
    const Harness harness;
    /* A pad holds one buffer at a time, so that the order matters. */
    harness.push_depth(0);
    harness.push_color(0);
    harness.push_depth(GST_SECOND / 10); /* its picture was lost */
    harness.push_color(2 * GST_SECOND / 10);
    harness.push_depth(2 * GST_SECOND / 10);
    for (const GstClockTime pts : {GstClockTime{0}, GstClockTime{2 * GST_SECOND / 10}}) {
        g_autoptr(GstBuffer) picture = gst_harness_pull(harness.color());
        EXPECT_EQ(GST_BUFFER_PTS(picture), pts);
    }
    EXPECT_EQ(harness.count("without-depth"), 0u);
}

TEST(LightFieldCompose, a_picture_whose_depth_was_lost_comes_out_flat)
{
    const Harness harness;
    harness.push_color(0, 77);
    harness.push_depth(GST_SECOND / 10);
    g_autoptr(GstBuffer) flat = gst_harness_pull(harness.color());
    EXPECT_EQ(GST_BUFFER_PTS(flat), 0u);
    EXPECT_EQ(harness.count("without-depth"), 1u);
    GstMapInfo map;
    gst_buffer_map(flat, &map, GST_MAP_READ);
    EXPECT_EQ(map.data[0], 77);
    gst_buffer_unmap(flat, &map);
}

TEST(LightFieldCompose, without_timestamps_the_kth_goes_with_the_kth)
{
    const Harness harness;
    for (int k = 0; k < 3; k++) {
        harness.push_color(GST_CLOCK_TIME_NONE);
        harness.push_depth(GST_CLOCK_TIME_NONE);
        gst_buffer_unref(gst_harness_pull(harness.color()));
    }
    EXPECT_EQ(harness.count("pictures"), 3u);
    EXPECT_EQ(harness.count("without-depth"), 0u);
}

TEST(LightFieldCompose, pictures_go_on_when_the_depth_has_ended)
{
    const Harness harness;
    harness.push_color(0);
    harness.end_of_depth();
    gst_buffer_unref(gst_harness_pull(harness.color()));
    EXPECT_EQ(harness.count("without-depth"), 1u);
}

TEST(LightFieldCompose, properties_change_while_it_runs)
{
    const Harness harness;
    harness.push_color(0);
    harness.push_depth(0);
    gst_buffer_unref(gst_harness_pull(harness.color()));
    g_object_set(harness.element(), "columns", 3, "depth-gain", 0.5, "view-cone", 20.0, nullptr);
    harness.push_color(GST_SECOND / 10);
    harness.push_depth(GST_SECOND / 10);
    g_autoptr(GstBuffer) wider = gst_harness_pull(harness.color());
    EXPECT_EQ(gst_buffer_get_size(wider), 3u * 32 * 3 * 16);
}

/* The messages of the element `l` with its disparity that are on the bus. */
static std::vector<std::pair<double, double>> told_disparities(const TestPipeline &pipeline)
{
    std::vector<std::pair<double, double>> told;
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline.bin());
    while (GstMessage *message = gst_bus_pop_filtered(bus, GST_MESSAGE_ELEMENT)) {
        const GstStructure *fields = gst_message_get_structure(message);
        double disparity = 0.0, sharp = 0.0;
        if (gst_structure_get(fields, "disparity", G_TYPE_DOUBLE, &disparity, "sharp-disparity",
                              G_TYPE_DOUBLE, &sharp, nullptr))
            told.emplace_back(disparity, sharp);
        gst_message_unref(message);
    }
    return told;
}

TEST(LightFieldCompose, the_disparity_is_told_once_a_change)
{
    std::string endless = scene();
    for (size_t at; (at = endless.find(" num-buffers=2")) != std::string::npos;)
        endless.erase(at, std::string(" num-buffers=2").size());
    TestPipeline pipeline(endless +
                          "layout=views columns=5 view-cone=30 depth-gain=0.1 ! appsink name=out sync=false "
                          "max-buffers=1");
    pipeline.play();
    const auto pull = [&] {
        for (int i = 0; i < 6; i++) /* more than lie between the element and the sink's end */
            gst_sample_unref(pipeline.pull("out"));
    };
    pull();
    auto told = told_disparities(pipeline);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NEAR(told[0].first, 0.1 * 96 * std::tan(15.0 * std::numbers::pi / 180.0), 1e-6);
    g_object_set(pipeline.element("l"), "depth-gain", 0.2, nullptr);
    pull();
    const auto changed = told_disparities(pipeline);
    ASSERT_EQ(changed.size(), 1u);
    EXPECT_NEAR(changed[0].first, 2.0 * told[0].first, 1e-6);
    EXPECT_EQ(changed[0].second, told[0].second);
    GstStructure *stats = nullptr;
    double disparity = 0.0;
    g_object_get(pipeline.element("l"), "stats", &stats, nullptr);
    gst_structure_get_double(stats, "disparity", &disparity);
    gst_structure_free(stats);
    EXPECT_EQ(disparity, changed[0].first);
}

TEST(LightFieldCompose, a_disparity_that_is_not_shown_sharply_is_a_warning_that_says_what_to_do)
{
    const std::string layout = "layout=views columns=5 view-cone=30 depth-gain=";
    EXPECT_EQ(run(scene() + layout + "0.14 ! fakesink").warning, "");
    const dff::Outcome blurred = run(scene() + layout + "0.3 ! fakesink");
    EXPECT_TRUE(blurred.end_of_stream);
    EXPECT_NE(blurred.warning.find("they move by 7.7 pixels"), std::string::npos) << blurred.warning;
    EXPECT_NE(blurred.warning.find("depth-gain of at most 0.15"), std::string::npos) << blurred.warning;
    for (const char *columns : {"columns=5", "columns=7", "columns=11"}) { /* what is advised is enough */
        const std::string others = std::string("layout=views view-cone=31 ") + columns + " depth-gain=";
        const std::string warning = run(scene() + others + "0.5 ! fakesink").warning;
        const std::string advised = "at most ";
        const double gain = std::stod(warning.substr(warning.find(advised) + advised.size()));
        EXPECT_EQ(run(scene() + others + std::to_string(gain) + " ! fakesink").warning, "") << warning;
    }
    EXPECT_EQ(run(scene() + "layout=rgbd depth-gain=9 ! fakesink").warning, "");
    EXPECT_EQ(run(scene() + "layout=views depth-gain=9 ! fakesink").warning, "");
}

TEST(LightFieldCompose, a_pad_that_is_not_linked_is_an_error_and_no_hang)
{
    const dff::Outcome outcome =
        run("videotestsrc num-buffers=1 ! videoconvert ! l.color lightfieldcompose name=l ! fakesink", 10);
    EXPECT_NE(outcome.error.find("\"depth\""), std::string::npos) << outcome.error;
}

TEST(LightFieldCompose, depth_of_another_size_is_an_error_that_names_both)
{
    const dff::Outcome outcome = run(scene("RGB", 48) + " ! fakesink");
    EXPECT_NE(outcome.error.find("48x64"), std::string::npos) << outcome.error;
    EXPECT_NE(outcome.error.find("96x64"), std::string::npos) << outcome.error;
}

TEST(LightFieldCompose, a_panel_without_its_calibration_is_an_error_that_says_what_to_do)
{
    const dff::Outcome none = run(scene() + "layout=lenticular ! fakesink");
    EXPECT_NE(none.error.find("display-calibration"), std::string::npos) << none.error;
    const dff::Outcome missing =
        run(scene() + "layout=lenticular display-calibration=/nonexistent.json ! fakesink");
    EXPECT_NE(missing.error.find("/nonexistent.json"), std::string::npos) << missing.error;
}

TEST(LightFieldCompose, a_quilt_with_fewer_pixels_than_views_is_an_error)
{
    const dff::Outcome outcome = run(scene() + "layout=quilt ! video/x-raw,width=7,height=7 ! fakesink");
    EXPECT_NE(outcome.error.find("7x7"), std::string::npos) << outcome.error;
}
