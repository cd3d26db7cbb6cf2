/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "../focalstack/support.h"
#include "shaken_stack.h"

#include <gst/video/video.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace {

constexpr unsigned planes = 4;
constexpr unsigned middle = 2;

const Shaking shaking{.size = {151, 117}, .planes = planes, .jitter = 2.0, .blur_step = 0.5};

GstFocalStackInfo stack_info(const char *format, cv::Size size, unsigned count = planes)
{
    GstFocalStackInfo info;
    info.frame = video_info(format, size.width, size.height);
    info.planes = count;
    GST_VIDEO_INFO_FPS_N(&info.frame) = 25;
    return info;
}

/* The picture of plane z that holds channel `channel`, in the default layout. */
cv::Mat channel_of(const GstFocalStackInfo &info, guint8 *data, unsigned z, unsigned channel)
{
    const auto *frame = &info.frame;
    const int bytes = GST_VIDEO_INFO_COMP_DEPTH(frame, channel) > 8 ? 2 : 1;
    const int samples = GST_VIDEO_INFO_COMP_PSTRIDE(frame, channel) / bytes;
    return cv::Mat(GST_VIDEO_INFO_COMP_HEIGHT(frame, channel), GST_VIDEO_INFO_COMP_WIDTH(frame, channel),
                   CV_MAKETYPE(bytes == 2 ? CV_16U : CV_8U, samples),
                   data + GST_VIDEO_INFO_SIZE(frame) * z +
                       GST_VIDEO_INFO_PLANE_OFFSET(frame, GST_VIDEO_INFO_COMP_PLANE(frame, channel)),
                   static_cast<size_t>(GST_VIDEO_INFO_COMP_STRIDE(frame, channel)));
}

/* Every colour channel shows the picture; chroma does so at half the size. */
void draw(const GstFocalStackInfo &info, guint8 *data, unsigned z, const cv::Mat &picture)
{
    for (unsigned i = 0; i < GST_VIDEO_INFO_N_PLANES(&info.frame); i++) {
        gint channels[GST_VIDEO_MAX_COMPONENTS];
        gst_video_format_info_component(info.frame.finfo, i, channels);
        cv::Mat packed = channel_of(info, data, z, static_cast<unsigned>(channels[0]));
        cv::Mat one;
        cv::resize(picture, one, packed.size(), 0.0, 0.0, cv::INTER_AREA);
        one.convertTo(one, packed.depth(), packed.depth() == CV_16U ? 200.0 : 1.0);
        cv::merge(std::vector<cv::Mat>(static_cast<size_t>(packed.channels()), one), packed);
    }
}

GstBuffer *new_stack(const GstFocalStackInfo &info, const std::vector<cv::Mat> &pictures)
{
    GstBuffer *stack = gst_buffer_new_allocate(nullptr, gst_focal_stack_info_get_size(&info), nullptr);
    GstMapInfo map;
    gst_buffer_map(stack, &map, GST_MAP_WRITE);
    for (unsigned z = 0; z < info.planes; z++)
        draw(info, map.data, z, pictures[z]);
    gst_buffer_unmap(stack, &map);
    return stack;
}

/* The element with stacks of one format going in. */
class FocalStackAlign : public testing::Test {
protected:
    void start(const GstFocalStackInfo &info)
    {
        info_ = info;
        Owned<GstCaps> caps(gst_focal_stack_info_to_caps(&info_));
        harness_.reset(gst_harness_new("focalstackalign"));
        gst_harness_set_src_caps(harness_.get(), gst_caps_ref(caps.get()));
        bus_ = gst_bus_new();
        gst_element_set_bus(harness_->element, bus_);
    }

    void TearDown() override
    {
        if (bus_)
            gst_element_set_bus(harness_->element, nullptr);
        harness_.reset();
        g_clear_object(&bus_);
    }

    Owned<GstBuffer> align(GstBuffer *stack)
    {
        EXPECT_EQ(gst_harness_push(harness_.get(), stack), GST_FLOW_OK);
        return Owned<GstBuffer>(gst_harness_try_pull(harness_.get()));
    }

    Owned<GstStructure> stats() const
    {
        GstStructure *structure = nullptr;
        g_object_get(harness_->element, "stats", &structure, nullptr);
        return Owned<GstStructure>(structure);
    }

    std::string last_error() const
    {
        g_autoptr(GstMessage) message = gst_bus_pop_filtered(bus_, GST_MESSAGE_ERROR);
        g_autoptr(GError) error = nullptr;
        if (!message)
            return {};
        gst_message_parse_error(message, &error, nullptr);
        return error->message;
    }

    /* How alike a plane and the middle plane are, by their normalised correlation away from the border. */
    double likeness(GstBuffer *stack, unsigned z, unsigned channel) const
    {
        GstMapInfo map;
        gst_buffer_map(stack, &map, GST_MAP_READ);
        const cv::Mat plane = channel_of(info_, map.data, z, channel);
        const cv::Mat reference = channel_of(info_, map.data, middle, channel);
        const cv::Rect inner(8, 8, plane.cols - 16, plane.rows - 16);
        cv::Mat a, b, score;
        cv::extractChannel(plane(inner), a, 0);
        cv::extractChannel(reference(inner), b, 0);
        a.convertTo(a, CV_32F);
        b.convertTo(b, CV_32F);
        cv::matchTemplate(a, b, score, cv::TM_CCOEFF_NORMED);
        gst_buffer_unmap(stack, &map);
        return score.at<float>(0);
    }

    GstFocalStackInfo info_{};
    Owned<GstHarness> harness_;
    GstBus *bus_ = nullptr;
};

class Formats : public FocalStackAlign, public testing::WithParamInterface<const char *> {};

struct PlaneStats {
    double dx = 0.0, dy = 0.0, scale = 0.0, rotation = 0.0;
    gboolean trusted = FALSE;
};

std::vector<PlaneStats> planes_of(const GstStructure *stats)
{
    std::vector<PlaneStats> result;
    const GValue *array = gst_structure_get_value(stats, "planes");
    for (guint z = 0; z < gst_value_array_get_size(array); z++) {
        const GstStructure *plane = gst_value_get_structure(gst_value_array_get_value(array, z));
        PlaneStats &values = result.emplace_back();
        EXPECT_TRUE(gst_structure_get(plane, "dx", G_TYPE_DOUBLE, &values.dx, "dy", G_TYPE_DOUBLE, &values.dy,
                                      "scale", G_TYPE_DOUBLE, &values.scale, "rotation", G_TYPE_DOUBLE,
                                      &values.rotation, "trusted", G_TYPE_BOOLEAN, &values.trusted, nullptr));
    }
    return result;
}

guint64 number_of(const GstStructure *stats, const char *name)
{
    guint64 number = G_MAXUINT64;
    gst_structure_get_uint64(stats, name, &number);
    return number;
}

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
                         testing::Values("GRAY8", "GRAY16_LE", "I420", "NV12", "RGB", "BGR", "RGBx", "BGRx"),
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

TEST_F(FocalStackAlign, times_and_metas_stay)
{
    const ShakenStack shaken(shaking);
    start(stack_info("NV12", shaken.size));
    GstBuffer *stack = new_stack(info_, shaken.planes);
    GST_BUFFER_PTS(stack) = 5 * GST_SECOND;
    GST_BUFFER_DURATION(stack) = 40 * GST_MSECOND;
    gst_focal_stack_info_add_video_metas(&info_, stack);
    GstFocalStackMeta *meta = gst_buffer_add_focal_stack_meta(stack, 17, planes);
    meta->complete = FALSE;
    meta->missing = 2;
    GstFocusInfo focus;
    gst_focus_info_init(&focus);
    focus.power = 3.5;
    gst_focal_stack_meta_set_focus(meta, 1, &focus);
    const Owned<GstCaps> clock(gst_caps_new_empty_simple("timestamp/x-camera"));
    gst_buffer_add_reference_timestamp_meta(stack, clock.get(), 123, 456);

    const Owned<GstBuffer> aligned = align(stack);
    EXPECT_EQ(GST_BUFFER_PTS(aligned.get()), 5 * GST_SECOND);
    EXPECT_EQ(GST_BUFFER_DURATION(aligned.get()), 40 * GST_MSECOND);
    meta = gst_buffer_get_focal_stack_meta(aligned.get());
    ASSERT_NE(meta, nullptr);
    EXPECT_EQ(meta->sequence, 17u);
    EXPECT_FALSE(meta->complete);
    EXPECT_EQ(meta->missing, 2u);
    ASSERT_TRUE(gst_focal_stack_meta_get_focus(meta, 1, &focus));
    EXPECT_EQ(focus.power, 3.5);
    const auto *time = gst_buffer_get_reference_timestamp_meta(aligned.get(), clock.get());
    ASSERT_NE(time, nullptr);
    EXPECT_EQ(time->timestamp, 123u);
    EXPECT_EQ(gst_buffer_get_n_meta(aligned.get(), GST_VIDEO_META_API_TYPE), planes);
}

TEST_F(FocalStackAlign, stack_is_one_memory_of_its_own_with_slack)
{
    const ShakenStack shaken(shaking);
    start(stack_info("I420", shaken.size));
    Owned<GstBuffer> input(new_stack(info_, shaken.planes));

    const Owned<GstBuffer> aligned = align(gst_buffer_ref(input.get()));
    ASSERT_EQ(gst_buffer_n_memory(aligned.get()), 1u);
    GstMemory *memory = gst_buffer_peek_memory(aligned.get(), 0);
    EXPECT_NE(memory, gst_buffer_peek_memory(input.get(), 0));
    EXPECT_EQ(memory->align, 4095u);
    EXPECT_EQ(memory->offset, 64u);
    EXPECT_GE(memory->maxsize, memory->offset + memory->size + 64);
    for (unsigned z = 0; z < planes; z++) {
        const GstVideoMeta *meta = gst_buffer_get_video_meta_id(aligned.get(), static_cast<gint>(z));
        ASSERT_NE(meta, nullptr);
        EXPECT_EQ(meta->offset[0], z * GST_VIDEO_INFO_SIZE(&info_.frame));
    }
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

TEST_F(FocalStackAlign, stacks_of_a_file_get_times)
{
    const ShakenStack shaken(shaking);
    start(stack_info("GRAY8", shaken.size));
    GstSegment bytes;
    gst_segment_init(&bytes, GST_FORMAT_BYTES);
    gst_harness_push_event(harness_.get(), gst_event_new_segment(&bytes));

    for (guint64 k = 0; k < 3; k++) {
        const Owned<GstBuffer> aligned = align(new_stack(info_, shaken.planes));
        EXPECT_EQ(GST_BUFFER_PTS(aligned.get()), k * 40 * GST_MSECOND);
        EXPECT_EQ(GST_BUFFER_DURATION(aligned.get()), 40 * GST_MSECOND);
    }
    g_autoptr(GstEvent) event = gst_pad_get_sticky_event(harness_->sinkpad, GST_EVENT_SEGMENT, 0);
    const GstSegment *segment = nullptr;
    gst_event_parse_segment(event, &segment);
    EXPECT_EQ(segment->format, GST_FORMAT_TIME);
}

TEST_F(FocalStackAlign, truncated_stack_is_an_error_that_names_both_sizes)
{
    start(stack_info("GRAY8", {100, 80}));

    EXPECT_EQ(gst_harness_push(harness_.get(), gst_buffer_new_allocate(nullptr, 1000, nullptr)),
              GST_FLOW_ERROR);
    const std::string message = last_error();
    EXPECT_NE(message.find("1000"), std::string::npos) << message;
    EXPECT_NE(message.find(std::to_string(gst_focal_stack_info_get_size(&info_))), std::string::npos)
        << message;
}

TEST_F(FocalStackAlign, smallest_and_longest_stacks_pass)
{
    start(stack_info("RGB", {1, 1}, 2));
    EXPECT_TRUE(align(new_stack(info_, {cv::Mat(1, 1, CV_8U, 1.0), cv::Mat(1, 1, CV_8U, 2.0)})));
    TearDown();

    const ShakenStack shaken({.size = {64, 64}, .planes = 64, .blur_step = 0.2});
    start(stack_info("I420", shaken.size, 64));
    EXPECT_TRUE(align(new_stack(info_, shaken.planes)));
    EXPECT_EQ(number_of(stats().get(), "untrusted-planes"), 0u);
}

TEST_F(FocalStackAlign, caps_may_change_between_stacks)
{
    const ShakenStack shaken(shaking);
    const ShakenStack other({.size = {96, 100}, .planes = 3, .blur_step = 0.5});
    start(stack_info("GRAY8", shaken.size));
    ASSERT_TRUE(align(new_stack(info_, shaken.planes)));

    info_ = stack_info("RGB", other.size, 3);
    const Owned<GstCaps> caps(gst_focal_stack_info_to_caps(&info_));
    gst_harness_push_event(harness_.get(), gst_event_new_caps(caps.get()));
    const Owned<GstBuffer> aligned = align(new_stack(info_, other.planes));
    EXPECT_EQ(gst_buffer_get_size(aligned.get()), gst_focal_stack_info_get_size(&info_));
    EXPECT_EQ(planes_of(stats().get()).size(), 3u);
}

TEST_F(FocalStackAlign, latency_includes_the_computation)
{
    const ShakenStack shaken(shaking);
    start(stack_info("GRAY8", shaken.size));
    gst_harness_set_upstream_latency(harness_.get(), 10 * GST_MSECOND);
    ASSERT_TRUE(align(new_stack(info_, shaken.planes)));

    EXPECT_GT(gst_harness_query_latency(harness_.get()), 10 * GST_MSECOND);
    EXPECT_EQ(count_messages(bus_, GST_MESSAGE_LATENCY), 1u);
}

TEST_F(FocalStackAlign, a_stack_outlives_its_element)
{
    const ShakenStack shaken(shaking);
    start(stack_info("GRAY8", shaken.size));
    const Owned<GstBuffer> aligned = align(new_stack(info_, shaken.planes));
    TearDown();

    EXPECT_GT(likeness(aligned.get(), 0, 0), 0.97);
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
