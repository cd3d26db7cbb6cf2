/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "support.h"

#include <cstring>
#include <gtest/gtest.h>

namespace {

[[maybe_unused]] const bool initialised = [] {
    gst_init(nullptr, nullptr);
    return true;
}();

} // namespace

Pipeline::Pipeline(const std::string &description)
{
    g_autoptr(GError) error = nullptr;
    GstElement *parsed =
        gst_parse_launch_full(description.c_str(), nullptr, GST_PARSE_FLAG_FATAL_ERRORS, &error);
    EXPECT_EQ(error, nullptr) << error->message;
    if (parsed && !GST_IS_PIPELINE(parsed)) {
        GstElement *pipeline = gst_pipeline_new(nullptr);
        gst_bin_add(GST_BIN(pipeline), parsed);
        parsed = pipeline;
    }
    pipeline_ = parsed;
}

Pipeline::~Pipeline()
{
    gst_element_set_state(pipeline_, GST_STATE_NULL);
    gst_object_unref(pipeline_);
}

GstElement *Pipeline::element(const char *name) const
{
    GstElement *element = gst_bin_get_by_name(GST_BIN(pipeline_), name);
    EXPECT_NE(element, nullptr) << name;
    if (element)
        gst_object_unref(element);
    return element;
}

Sample Pipeline::pull(const char *sink) const
{
    return Sample(gst_app_sink_try_pull_sample(GST_APP_SINK(element(sink)), patience));
}

std::vector<Sample> Pipeline::pull_all(const char *sink) const
{
    std::vector<Sample> samples;
    while (Sample sample = pull(sink))
        samples.push_back(std::move(sample));
    return samples;
}

std::string Pipeline::wait()
{
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline_);
    g_autoptr(GstMessage) message = gst_bus_timed_pop_filtered(
        bus, patience, static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS));
    if (!message)
        return "timeout";
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS)
        return "";
    g_autoptr(GError) error = nullptr;
    gst_message_parse_error(message, &error, nullptr);
    return error->message;
}

std::string Pipeline::run()
{
    set_state(GST_STATE_PLAYING);
    return wait();
}

GstVideoInfo info_of(GstSample *sample)
{
    GstVideoInfo info;
    gst_video_info_from_caps(&info, gst_sample_get_caps(sample));
    return info;
}

std::vector<uint8_t> bytes_of(GstSample *sample)
{
    GstMapInfo map;
    gst_buffer_map(gst_sample_get_buffer(sample), &map, GST_MAP_READ);
    std::vector<uint8_t> bytes(map.data, map.data + map.size);
    gst_buffer_unmap(gst_sample_get_buffer(sample), &map);
    return bytes;
}

std::vector<uint16_t> depth_of(GstSample *sample)
{
    const GstVideoInfo info = info_of(sample);
    const std::vector<uint8_t> bytes = bytes_of(sample);
    const auto width = static_cast<size_t>(GST_VIDEO_INFO_WIDTH(&info));
    const auto height = static_cast<size_t>(GST_VIDEO_INFO_HEIGHT(&info));
    const auto stride = static_cast<size_t>(GST_VIDEO_INFO_PLANE_STRIDE(&info, 0));
    std::vector<uint16_t> depth(width * height);
    for (size_t y = 0; y < height; y++)
        std::memcpy(depth.data() + y * width, bytes.data() + y * stride, width * sizeof(uint16_t));
    return depth;
}

const GstFocusMeta *focus_of(const Sample &sample)
{
    return gst_buffer_get_focus_meta(gst_sample_get_buffer(sample.get()));
}
