/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depth_frame.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

using namespace dff;

namespace {

constexpr unsigned width = 320;
constexpr unsigned height = 240;
constexpr double hue_steps = 1275;

/* A slope with a near box and a hole in it. */
guint16 scene(unsigned x, unsigned y)
{
    if (x >= 80 && x < 160 && y >= 80 && y < 160)
        return 0;
    if (x >= 180 && x < 260 && y >= 60 && y < 180)
        return 3000;
    return static_cast<guint16>(1 + 65534 * x / (width - 1));
}

Buffer through(const std::string &pipeline, const PixelAt &pixel_at = scene)
{
    const Harness harness = depth_harness(pipeline, width, height);
    gst_harness_push(harness.get(), depth_frame(width, height, pixel_at).release());
    gst_harness_push_event(harness.get(), gst_event_new_eos());
    return Buffer(gst_harness_pull(harness.get()));
}

} // namespace

TEST(DepthColorize, colours_no_longer_say_that_they_are_depth)
{
    const Harness harness = depth_harness("depthcolorize", width, height);
    const GstDepthInfo depth = dioptres_from_5_to_1();
    Buffer frame = depth_frame(width, height, scene);
    gst_buffer_add_depth_meta(frame.get(), &depth);
    gst_harness_push(harness.get(), frame.release());
    const Buffer picture(gst_harness_pull(harness.get()));
    EXPECT_EQ(gst_buffer_get_depth_meta(picture.get()), nullptr);
    EXPECT_EQ(caps_string(harness.get()).find("depth-"), std::string::npos);
    EXPECT_EQ(gst_buffer_get_size(picture.get()), width * height * 3);
}

TEST(DepthColorize, hue_comes_back_with_its_caps_and_meta)
{
    const Harness harness =
        depth_harness("depthcolorize palette=hue ! depthuncolorize near=5 far=1", width, height);
    for (guint64 k = 0; k < 2; k++) {
        gst_harness_push(harness.get(), depth_frame(width, height, scene).release());
        const Buffer back(gst_harness_pull(harness.get()));
        const GstDepthMeta *meta = gst_buffer_get_depth_meta(back.get());
        ASSERT_NE(meta, nullptr);
        EXPECT_EQ(meta->unit, GST_DEPTH_UNIT_DIOPTRE);
        EXPECT_NEAR(meta->offset + meta->scale, 5.0, 1e-9);
        EXPECT_NEAR(meta->offset + meta->scale * 65535, 1.0, 1e-9);
        EXPECT_EQ(meta->sequence, k);
        const std::vector<guint16> pixels = pixels_of(back.get());
        for (unsigned y = 0; y < height; y += 7)
            for (unsigned x = 0; x < width; x++) {
                ASSERT_EQ(pixels[y * width + x] == 0, scene(x, y) == 0);
                ASSERT_NEAR(pixels[y * width + x], scene(x, y), 0.51 * 65534 / hue_steps);
            }
    }
    const std::string caps = caps_string(harness.get());
    for (const char *field : {"depth-unit=(string)dioptre", "depth-near=(double)5", "depth-far=(double)1"})
        EXPECT_NE(caps.find(field), std::string::npos) << caps;
}

TEST(DepthColorize, millimetres_come_back)
{
    const Harness harness = depth_harness(
        "depthcolorize palette=hue near=4 far=0.5 ! depthuncolorize unit=millimetre near=4 far=0.5", width,
        height);
    gst_harness_set_src_caps_str(harness.get(),
                                 "video/x-raw,format=GRAY16_LE,width=320,height=240,framerate=26/1,"
                                 "depth-unit=millimetre");
    gst_harness_push(harness.get(),
                     depth_frame(width, height, [](unsigned, unsigned) { return 800; }).release());
    const Buffer back(gst_harness_pull(harness.get()));
    EXPECT_NEAR(pixels_of(back.get())[0], 800, 1);
}

TEST(DepthColorize, a_hue_video_keeps_depth_and_holes_through_h264)
{
    const Buffer back =
        through("depthcolorize palette=hue ! videoconvert ! video/x-raw,format=I420 ! x264enc bitrate=4000 ! "
                "h264parse ! avdec_h264 ! videoconvert ! depthuncolorize near=5 far=1");
    const std::vector<guint16> pixels = pixels_of(back.get());
    std::vector<double> errors; /* in dioptres */
    unsigned wrong_holes = 0;
    for (unsigned y = 0; y < height; y++)
        for (unsigned x = 0; x < width; x++) {
            const guint16 before = scene(x, y), after = pixels[y * width + x];
            if ((before == 0) != (after == 0))
                wrong_holes++;
            else
                errors.push_back(std::abs(before - after) * 4.0 / 65534);
        }
    std::ranges::sort(errors);
    EXPECT_LT(errors[errors.size() / 2], 0.02);
    EXPECT_LT(errors[errors.size() * 95 / 100], 0.06);
    EXPECT_LT(wrong_holes, width * height / 200);
}

TEST(DepthColorize, millimetres_without_a_range_are_an_error_that_says_what_to_do)
{
    const Harness harness = depth_harness("depthcolorize", width, height);
    g_autoptr(GstBus) bus = gst_bus_new();
    gst_element_set_bus(harness->element, bus);
    gst_harness_set_src_caps_str(harness.get(),
                                 "video/x-raw,format=GRAY16_LE,width=320,height=240,framerate=26/1,"
                                 "depth-unit=millimetre");
    EXPECT_EQ(gst_harness_push(harness.get(), depth_frame(width, height, scene).release()), GST_FLOW_ERROR);
    g_autoptr(GstMessage) message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
    ASSERT_NE(message, nullptr);
    g_autoptr(GError) error = nullptr;
    gst_message_parse_error(message, &error, nullptr);
    EXPECT_NE(std::string(error->message).find("set near and far"), std::string::npos) << error->message;
    gst_element_set_bus(harness->element, nullptr);
}
