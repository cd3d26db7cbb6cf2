/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "align_test.h"

namespace {

class Formats : public FocalStackAlign, public testing::WithParamInterface<const char *> {};

} // namespace

TEST_P(Formats, planes_come_to_lie_on_the_middle_one)
{
    const ShakenStack shaken(shaking);
    start(stack_info(GetParam(), shaken.size));

    Owned<GstBuffer> input(new_stack(info_, shaken.planes));
    const Owned<GstBuffer> aligned = align(gst_buffer_ref(input.get()));
    ASSERT_TRUE(aligned);
    for (unsigned z = 0; z < planes; z++) {
        for (unsigned channel = 0; channel < GST_VIDEO_INFO_N_COMPONENTS(&info_.frame); channel++) {
            EXPECT_GT(likeness(aligned.get(), z, channel), 0.97) << "plane " << z << " channel " << channel;
            if (z != middle) {
                EXPECT_LT(likeness(input.get(), z, channel), 0.95) << "the test is too easy";
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(FocalStackAlign, Formats,
                         testing::Values("GRAY8", "GRAY16_LE", "I420", "NV12", "RGB", "BGR", "RGBx", "BGRx",
                                         "RGBA64_LE"),
                         [](const auto &format) { return std::string(format.param); });

TEST_F(FocalStackAlign, stats_tell_shift_and_zoom_of_each_plane)
{
    const ShakenStack shaken(shaking);
    start(stack_info("GRAY8", shaken.size));
    ASSERT_TRUE(align(new_stack(info_, shaken.planes)));

    const Owned<GstStructure> structure = stats();
    const std::vector<PlaneStats> found = planes_of(structure.get());
    ASSERT_EQ(found.size(), planes);
    EXPECT_EQ(number_of(structure.get(), "stacks"), 1u);
    EXPECT_EQ(number_of(structure.get(), "untrusted-planes"), 0u);

    const cv::Point2d origin = shaken.warps[middle].inverse().apply({0.0, 0.0});
    for (unsigned z = 0; z < planes; z++) {
        const cv::Point2d shift = shaken.warps[z].apply(origin);
        EXPECT_NEAR(found[z].dx, shift.x, 0.1);
        EXPECT_NEAR(found[z].dy, shift.y, 0.1);
        EXPECT_NEAR(found[z].scale, shaken.warps[z].scale() / shaken.warps[middle].scale(), 0.001);
        EXPECT_NEAR(found[z].rotation, 0.0, 0.1);
        EXPECT_TRUE(found[z].trusted);
    }
}

TEST_F(FocalStackAlign, stack_without_texture_passes_untouched_and_untrusted)
{
    start(stack_info("RGB", {80, 64}));
    const Owned<GstBuffer> input(
        gst_buffer_new_allocate(nullptr, gst_focal_stack_info_get_size(&info_), nullptr));
    gst_buffer_memset(input.get(), 0, 99, gst_buffer_get_size(input.get()));

    const Owned<GstBuffer> aligned = align(gst_buffer_ref(input.get()));
    GstMapInfo map;
    gst_buffer_map(input.get(), &map, GST_MAP_READ);
    EXPECT_EQ(gst_buffer_memcmp(aligned.get(), 0, map.data, map.size), 0);
    gst_buffer_unmap(input.get(), &map);
    EXPECT_EQ(number_of(stats().get(), "untrusted-planes"), planes - 1);
}

TEST_F(FocalStackAlign, padded_rows_are_read_by_their_video_metas)
{
    const ShakenStack shaken(shaking);
    start(stack_info("GRAY8", shaken.size));
    const auto stride = static_cast<gint>(shaken.size.width + 49);
    const gsize frame = static_cast<gsize>(stride * shaken.size.height);
    GstBuffer *stack = gst_buffer_new_allocate(nullptr, frame * planes, nullptr);
    GstMapInfo map;
    gst_buffer_map(stack, &map, GST_MAP_WRITE);
    for (unsigned z = 0; z < planes; z++) {
        gsize offset[GST_VIDEO_MAX_PLANES] = {frame * z};
        gint strides[GST_VIDEO_MAX_PLANES] = {stride};
        shaken.planes[z].copyTo(
            cv::Mat(shaken.size, CV_8U, map.data + offset[0], static_cast<size_t>(stride)));
        gst_buffer_add_video_meta_full(stack, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_GRAY8,
                                       static_cast<guint>(shaken.size.width),
                                       static_cast<guint>(shaken.size.height), 1, offset, strides)
            ->id = static_cast<gint>(z);
    }
    gst_buffer_unmap(stack, &map);

    const Owned<GstBuffer> aligned = align(stack);
    EXPECT_EQ(gst_buffer_get_size(aligned.get()), gst_focal_stack_info_get_size(&info_));
    for (unsigned z = 0; z < planes; z++)
        EXPECT_GT(likeness(aligned.get(), z, 0), 0.97) << "plane " << z;
}

TEST_F(FocalStackAlign, a_plane_that_does_not_fit_is_told_once_and_not_shown)
{
    ShakenStack shaken(shaking);
    cv::flip(shaken.planes[0], shaken.planes[0], -1);
    start(stack_info("RGB", shaken.size));
    ASSERT_TRUE(align(new_stack(info_, shaken.planes)));
    const Owned<GstBuffer> aligned = align(new_stack(info_, shaken.planes));

    EXPECT_EQ(number_of(stats().get(), "untrusted-planes"), 2u);
    EXPECT_GT(likeness(aligned.get(), 0, 0), 0.9);
    EXPECT_EQ(count_messages(bus_, GST_MESSAGE_WARNING), 1u);
}

/* They stay where they are, while the picture moves. */
TEST_F(FocalStackAlign, bad_pixels_of_the_sensor_are_left_out_and_counted)
{
    const ShakenStack shaken({.size = {160, 120}, .planes = 6, .jitter = 2.0});
    const std::vector<cv::Point> places = {{30, 20}, {81, 60}, {120, 90}};
    const auto moved = [&](int by, bool is_spoilt) {
        std::vector<cv::Mat> stack;
        for (const cv::Mat &plane : shaken.planes) {
            stack.emplace_back();
            cv::hconcat(plane.colRange(by, plane.cols), plane.colRange(0, by), stack.back());
            for (const cv::Point &place : places)
                if (is_spoilt)
                    stack.back().at<uchar>(place) = 255;
        }
        return stack;
    };
    constexpr int stacks = 8, step = 5;
    start(stack_info("GRAY8", shaken.size, 6));
    const Owned<GstBuffer> good = align(new_stack(info_, moved(stacks * step, false)));
    TearDown();
    start(stack_info("GRAY8", shaken.size, 6));
    Owned<GstBuffer> repaired;
    for (int i = 1; i <= stacks; i++)
        repaired = align(new_stack(info_, moved(i * step, true)));

    GstMapInfo map, expected;
    gst_buffer_map(repaired.get(), &map, GST_MAP_READ);
    gst_buffer_map(good.get(), &expected, GST_MAP_READ);
    const int size = static_cast<int>(map.size);
    EXPECT_LT(
        cv::norm(cv::Mat(1, size, CV_8U, map.data), cv::Mat(1, size, CV_8U, expected.data), cv::NORM_INF),
        60.0);
    gst_buffer_unmap(repaired.get(), &map);
    gst_buffer_unmap(good.get(), &expected);
    EXPECT_EQ(number_of(stats().get(), "bad-pixels"), places.size());
}

TEST_F(FocalStackAlign, planes_that_all_fit_warn_of_nothing)
{
    const ShakenStack shaken(shaking);
    start(stack_info("RGB", shaken.size));
    ASSERT_TRUE(align(new_stack(info_, shaken.planes)));

    EXPECT_EQ(count_messages(bus_, GST_MESSAGE_WARNING), 0u);
}

TEST_F(FocalStackAlign, a_model_can_be_asked_for)
{
    const ShakenStack shaken(
        {.size = {320, 240}, .planes = planes, .jitter = 2.0, .tilt = 0.02, .blur_step = 0.5});
    for (const auto &[model, has_perspective] :
         {std::pair{"auto", true}, {"homography", true}, {"similarity", false}}) {
        start(stack_info("GRAY8", shaken.size));
        gst_util_set_object_arg(G_OBJECT(harness_->element), "motion-model", model);
        ASSERT_TRUE(align(new_stack(info_, shaken.planes)));
        EXPECT_EQ(std::abs(planes_of(stats().get())[0].perspective) > 1e-6, has_perspective) << model;
        TearDown();
    }
}

TEST_P(Formats, planes_come_to_be_equally_bright)
{
    ShakenStack shaken(shaking);
    for (unsigned z = 0; z < planes; z++)
        shaken.planes[z].convertTo(shaken.planes[z], -1, 0.6 + 0.1 * z, 20.0);
    start(stack_info(GetParam(), shaken.size));
    g_object_set(harness_->element, "even-brightness", TRUE, nullptr);
    const Owned<GstBuffer> aligned = align(new_stack(info_, shaken.planes));
    ASSERT_TRUE(aligned);

    for (unsigned z = 0; z < planes; z++) {
        for (unsigned channel = 0; channel < GST_VIDEO_INFO_N_COMPONENTS(&info_.frame); channel++)
            EXPECT_NEAR(brightness(aligned.get(), z, channel) / brightness(aligned.get(), middle, channel),
                        1.0, 0.03)
                << "plane " << z << " channel " << channel;
    }
}

TEST(FocalStackAlignPipeline, breathing_of_a_simulated_sweep_is_undone)
{
    g_autoptr(GstElementFactory) source = gst_element_factory_find("lenssweeptestsrc");
    if (!source)
        GTEST_SKIP() << "the plug-in lenssweep is not built";

    g_autoptr(GError) error = nullptr;
    g_autoptr(GstElement) pipeline = gst_parse_launch(
        "lenssweeptestsrc num-buffers=12 breathing=0.03 noise=moderate ! video/x-raw,width=320,height=240 ! "
        "focalstackmux ! queue ! focalstackalign name=align ! fakesink name=sink",
        &error);
    ASSERT_EQ(error, nullptr) << error->message;

    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline);
    g_autoptr(GstMessage) message = gst_bus_timed_pop_filtered(
        bus, 60 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
    ASSERT_NE(message, nullptr);
    EXPECT_EQ(GST_MESSAGE_TYPE(message), GST_MESSAGE_EOS);

    g_autoptr(GstElement) align = gst_bin_get_by_name(GST_BIN(pipeline), "align");
    GstStructure *structure = nullptr;
    g_object_get(align, "stats", &structure, nullptr);
    const Owned<GstStructure> stats(structure);
    const std::vector<PlaneStats> found = planes_of(stats.get());
    ASSERT_EQ(found.size(), 6u);
    EXPECT_EQ(number_of(stats.get(), "stacks"), 2u);
    EXPECT_EQ(number_of(stats.get(), "untrusted-planes"), 0u);
    EXPECT_NEAR(found[5].scale / found[0].scale, 1.03, 0.003);
    for (const PlaneStats &plane : found)
        EXPECT_LT(std::hypot(plane.dx, plane.dy), 0.3);
    gst_element_set_state(pipeline, GST_STATE_NULL);
}
