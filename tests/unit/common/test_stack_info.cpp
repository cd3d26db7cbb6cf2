/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include <gst/dff/dff.h>

#include <cmath>
#include <gtest/gtest.h>
#include <string>

namespace {

class StackInfo : public testing::Test {
protected:
    static GstFocalStackInfo parse(const char *text)
    {
        GstFocalStackInfo info;
        g_autoptr(GstCaps) caps = gst_caps_from_string(text);
        EXPECT_TRUE(gst_focal_stack_info_from_caps(&info, caps)) << text;
        return info;
    }

    static bool can_parse(const char *text)
    {
        GstFocalStackInfo info;
        g_autoptr(GstCaps) caps = gst_caps_from_string(text);
        return gst_focal_stack_info_from_caps(&info, caps);
    }

    std::string locate_error(const GstFocalStackInfo &info, GstBuffer *buffer, unsigned plane)
    {
        g_autoptr(GError) error = nullptr;
        if (gst_focal_stack_info_locate_plane(&info, buffer, plane, offset_, stride_, &error))
            return "";
        return error->message;
    }

    gsize offset_[GST_VIDEO_MAX_PLANES] = {};
    gint stride_[GST_VIDEO_MAX_PLANES] = {};
};

constexpr const char *small = "video/x-focal-stack,format=I420,width=33,height=17,planes=3,framerate=26/1";

} // namespace

TEST_F(StackInfo, caps_come_back)
{
    const GstFocalStackInfo info = parse(small);
    EXPECT_EQ(info.planes, 3u);
    EXPECT_EQ(GST_VIDEO_INFO_WIDTH(&info.frame), 33);
    EXPECT_EQ(GST_VIDEO_INFO_FPS_N(&info.frame), 26);
    g_autoptr(GstCaps) caps = gst_focal_stack_info_to_caps(&info);
    g_autoptr(GstCaps) wanted = gst_caps_from_string(small);
    EXPECT_TRUE(gst_caps_is_subset(caps, wanted));
    g_autoptr(GstCaps) allowed = gst_caps_from_string(GST_FOCAL_STACK_CAPS_MAKE);
    EXPECT_TRUE(gst_caps_is_subset(caps, allowed));
}

TEST_F(StackInfo, colorimetry_goes_along)
{
    const GstFocalStackInfo info =
        parse("video/x-focal-stack,format=I420,width=32,height=16,planes=3,framerate=26/1,colorimetry=bt709");
    EXPECT_TRUE(gst_video_colorimetry_matches(&info.frame.colorimetry, "bt709"));
}

TEST_F(StackInfo, other_caps_are_refused)
{
    EXPECT_FALSE(can_parse("video/x-raw,format=I420,width=32,height=16,planes=3,framerate=26/1"));
    EXPECT_FALSE(can_parse("video/x-focal-stack,format=I420,width=32,height=16,framerate=26/1"));
    EXPECT_FALSE(can_parse("video/x-focal-stack,format=I420,width=32,height=16,planes=1,framerate=26/1"));
    EXPECT_FALSE(can_parse("video/x-focal-stack,format=I420,width=32,height=16,planes=65,framerate=26/1"));
    EXPECT_FALSE(can_parse("video/x-focal-stack,format=nonsense,width=32,height=16,planes=2,framerate=26/1"));
    EXPECT_FALSE(can_parse("video/x-focal-stack,format=v210,width=32,height=16,planes=2,framerate=26/1"));
}

TEST_F(StackInfo, planes_without_metas_lie_one_after_the_other)
{
    const GstFocalStackInfo info = parse(small);
    const gsize frame = GST_VIDEO_INFO_SIZE(&info.frame);
    ASSERT_EQ(gst_focal_stack_info_get_size(&info), 3 * frame);
    g_autoptr(GstBuffer) stack = gst_buffer_new_allocate(nullptr, 3 * frame, nullptr);
    ASSERT_EQ(locate_error(info, stack, 2), "");
    EXPECT_EQ(offset_[0], 2 * frame);
    EXPECT_EQ(offset_[1], 2 * frame + GST_VIDEO_INFO_PLANE_OFFSET(&info.frame, 1));
    EXPECT_EQ(stride_[2], GST_VIDEO_INFO_PLANE_STRIDE(&info.frame, 2));
}

TEST_F(StackInfo, added_metas_say_the_same_as_the_default_layout)
{
    const GstFocalStackInfo info = parse(small);
    g_autoptr(GstBuffer) stack =
        gst_buffer_new_allocate(nullptr, gst_focal_stack_info_get_size(&info), nullptr);
    ASSERT_EQ(locate_error(info, stack, 1), "");
    const gsize bare = offset_[2];
    gst_focal_stack_info_add_video_metas(&info, stack);
    EXPECT_EQ(gst_buffer_get_n_meta(stack, GST_VIDEO_META_API_TYPE), 3u);
    ASSERT_EQ(locate_error(info, stack, 1), "");
    EXPECT_EQ(offset_[2], bare);
}

TEST_F(StackInfo, a_wrong_size_is_told_with_both_sizes)
{
    const GstFocalStackInfo info =
        parse("video/x-focal-stack,format=GRAY8,width=100,height=10,planes=2,framerate=1/1");
    for (const gsize size : {1999u, 2001u}) {
        g_autoptr(GstBuffer) stack = gst_buffer_new_allocate(nullptr, size, nullptr);
        const std::string error = locate_error(info, stack, 0);
        EXPECT_NE(error.find(std::to_string(size)), std::string::npos) << error;
        EXPECT_NE(error.find("2000"), std::string::npos) << error;
    }
}

TEST_F(StackInfo, tight_rows_are_named)
{
    const GstFocalStackInfo info =
        parse("video/x-focal-stack,format=RGB,width=65,height=10,planes=2,framerate=1/1");
    g_autoptr(GstBuffer) stack = gst_buffer_new_allocate(nullptr, 2 * 10 * 195, nullptr);
    const std::string error = locate_error(info, stack, 0);
    for (const char *word : {"tight", "195", "multiples of 4", "196", "3900", "3920"})
        EXPECT_NE(error.find(word), std::string::npos) << error;
}

TEST_F(StackInfo, a_meta_of_other_planes_or_impossible_powers_is_not_believed)
{
    const GstFocalStackInfo info =
        parse("video/x-focal-stack,format=GRAY8,width=64,height=64,planes=3,framerate=1/1");
    const auto error_of = [&](unsigned planes, double power) {
        g_autoptr(GstBuffer) stack = gst_buffer_new();
        g_autoptr(GError) error = nullptr;
        GstFocusInfo focus;
        gst_focus_info_init(&focus);
        focus.power = power;
        gst_focal_stack_meta_set_focus(gst_buffer_add_focal_stack_meta(stack, 9, planes), 1, &focus);
        const GstFocalStackMeta *meta = gst_focal_stack_info_get_meta(&info, stack, &error);
        EXPECT_EQ(meta == nullptr, error != nullptr);
        return std::string(error ? error->message : "");
    };
    EXPECT_EQ(error_of(3, 2.0), "");
    EXPECT_EQ(error_of(3, NAN), "") << "unknown";
    EXPECT_NE(error_of(64, 2.0).find("64 planes, but its caps of 3"), std::string::npos);
    EXPECT_NE(error_of(2, 2.0), "");
    for (const double power : {HUGE_VAL, -HUGE_VAL, 1e7})
        EXPECT_NE(error_of(3, power).find("Plane 1 of stack 9"), std::string::npos);

    g_autoptr(GstBuffer) bare = gst_buffer_new();
    g_autoptr(GError) error = nullptr;
    EXPECT_EQ(gst_focal_stack_info_get_meta(&info, bare, &error), nullptr);
    EXPECT_EQ(error, nullptr);
}

TEST_F(StackInfo, metas_that_reach_out_of_the_stack_are_told_with_both_sizes)
{
    const GstFocalStackInfo info =
        parse("video/x-focal-stack,format=GRAY8,width=100,height=10,planes=2,framerate=1/1");
    g_autoptr(GstBuffer) stack = gst_buffer_new_allocate(nullptr, 2000, nullptr);
    gst_focal_stack_info_add_video_metas(&info, stack);
    gst_buffer_get_video_meta_id(stack, 1)->offset[0] = 1500;
    const std::string error = locate_error(info, stack, 1);
    EXPECT_NE(error.find("2000"), std::string::npos) << error;
    EXPECT_NE(error.find("2500"), std::string::npos) << error;
}

TEST_F(StackInfo, impossible_metas_are_refused)
{
    const GstFocalStackInfo info =
        parse("video/x-focal-stack,format=GRAY8,width=100,height=10,planes=2,framerate=1/1");
    g_autoptr(GstBuffer) stack = gst_buffer_new_allocate(nullptr, 2000, nullptr);
    gst_focal_stack_info_add_video_metas(&info, stack);
    GstVideoMeta *meta = gst_buffer_get_video_meta_id(stack, 1);
    const GstVideoMeta whole = *meta;

    meta->stride[0] = -100;
    EXPECT_NE(locate_error(info, stack, 1), "");
    meta->stride[0] = 99;
    EXPECT_NE(locate_error(info, stack, 1), "");
    *meta = whole;
    meta->offset[0] = G_MAXSIZE - 500;
    EXPECT_NE(locate_error(info, stack, 1), "");
    *meta = whole;
    meta->width = 50;
    EXPECT_NE(locate_error(info, stack, 1), "");
    *meta = whole;
    meta->id = 7;
    EXPECT_NE(locate_error(info, stack, 1).find("plane 1 of 2"), std::string::npos);
    EXPECT_EQ(locate_error(info, stack, 0), "");
}
