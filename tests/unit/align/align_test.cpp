/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "align_test.h"

#include "common/stack_place.h"

#include <gst/video/video.h>
#include <opencv2/imgproc.hpp>

namespace {

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

/* Every colour channel shows the picture; chroma does so at half the size; alpha is opaque. */
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
        if (GST_VIDEO_INFO_HAS_ALPHA(&info.frame))
            cv::insertChannel(cv::Mat(packed.size(), packed.depth(), cv::Scalar::all(65535)), packed,
                              GST_VIDEO_COMP_A);
    }
}

} // namespace

GstFocalStackInfo stack_info(const char *format, cv::Size size, unsigned count)
{
    GstFocalStackInfo info;
    info.frame = video_info(format, size.width, size.height);
    info.planes = count;
    GST_VIDEO_INFO_FPS_N(&info.frame) = 25;
    return info;
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
        const GValue *matrix = gst_structure_get_value(plane, "matrix");
        values.perspective = g_value_get_double(gst_value_array_get_value(matrix, 6));
    }
    return result;
}

guint64 number_of(const GstStructure *stats, const char *name)
{
    guint64 number = G_MAXUINT64;
    gst_structure_get_uint64(stats, name, &number);
    return number;
}

void FocalStackAlign::start(const GstFocalStackInfo &info, bool wants_place)
{
    info_ = info;
    Owned<GstCaps> caps(gst_focal_stack_info_to_caps(&info_));
    harness_.reset(gst_harness_new("focalstackalign"));
    if (wants_place)
        gst_harness_add_propose_allocation_meta(harness_.get(), dff::stack_place_meta_api(), nullptr);
    gst_harness_set_src_caps(harness_.get(), gst_caps_ref(caps.get()));
    bus_ = gst_bus_new();
    gst_element_set_bus(harness_->element, bus_);
}

void FocalStackAlign::TearDown()
{
    if (bus_)
        gst_element_set_bus(harness_->element, nullptr);
    harness_.reset();
    g_clear_object(&bus_);
}

Owned<GstBuffer> FocalStackAlign::align(GstBuffer *stack)
{
    EXPECT_EQ(gst_harness_push(harness_.get(), stack), GST_FLOW_OK);
    return Owned<GstBuffer>(gst_harness_try_pull(harness_.get()));
}

Owned<GstStructure> FocalStackAlign::stats() const
{
    GstStructure *structure = nullptr;
    g_object_get(harness_->element, "stats", &structure, nullptr);
    return Owned<GstStructure>(structure);
}

std::string FocalStackAlign::last_error() const
{
    g_autoptr(GstMessage) message = gst_bus_pop_filtered(bus_, GST_MESSAGE_ERROR);
    g_autoptr(GError) error = nullptr;
    if (!message)
        return {};
    gst_message_parse_error(message, &error, nullptr);
    return error->message;
}

double FocalStackAlign::likeness(GstBuffer *stack, unsigned z, unsigned channel) const
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

double FocalStackAlign::brightness(GstBuffer *stack, unsigned z, unsigned channel) const
{
    GstMapInfo map;
    gst_buffer_map(stack, &map, GST_MAP_READ);
    const double mean = cv::mean(channel_of(info_, map.data, z, channel))[0];
    gst_buffer_unmap(stack, &map);
    return mean;
}
