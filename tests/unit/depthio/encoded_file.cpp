/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "encoded_file.h"

#include <algorithm>

namespace dff {

namespace {

std::string source(const char *pad, const std::string &caps)
{
    return std::string(" appsrc name=") + pad + " format=time caps=\"" + caps + ",framerate=26/1\" ! e." +
           pad;
}

void feed(GstElement *pipeline, const char *name, Buffer buffer)
{
    g_autoptr(GstElement) source = gst_bin_get_by_name(GST_BIN(pipeline), name);
    GstFlowReturn flow = GST_FLOW_OK;
    GST_BUFFER_PTS(buffer.get()) = GST_SECOND;
    g_signal_emit_by_name(source, "push-buffer", buffer.get(), &flow);
    g_signal_emit_by_name(source, "end-of-stream", &flow);
}

std::vector<guint8> pull(GstElement *pipeline)
{
    g_autoptr(GstElement) sink = gst_bin_get_by_name(GST_BIN(pipeline), "out");
    g_autoptr(GstSample) sample = nullptr;
    g_signal_emit_by_name(sink, "try-pull-sample", 20 * GST_SECOND, &sample);
    if (!sample)
        return {};
    GstBuffer *buffer = gst_sample_get_buffer(sample);
    std::vector<guint8> bytes(gst_buffer_get_size(buffer));
    gst_buffer_extract(buffer, 0, bytes.data(), bytes.size());
    return bytes;
}

std::string first_error(GstElement *pipeline)
{
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline);
    g_autoptr(GstMessage) message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
    g_autoptr(GError) error = nullptr;
    if (message)
        gst_message_parse_error(message, &error, nullptr);
    return error ? error->message : "";
}

} // namespace

Buffer colour_frame(unsigned width, unsigned height,
                    const std::function<std::array<guint8, 3>(unsigned, unsigned)> &at)
{
    GstBuffer *frame = gst_buffer_new_allocate(nullptr, gsize{3} * width * height, nullptr);
    GstMapInfo map;
    gst_buffer_map(frame, &map, GST_MAP_WRITE);
    for (unsigned y = 0; y < height; y++)
        for (unsigned x = 0; x < width; x++)
            std::ranges::copy(at(x, y), map.data + 3 * (gsize{y} * width + x));
    gst_buffer_unmap(frame, &map);
    return Buffer(frame);
}

EncodedFile encode_file(const std::string &encoder, unsigned width, unsigned height, Buffer colour,
                        Buffer depth, const std::string &depth_caps, FurtherInputs further)
{
    const std::string size = ",width=" + std::to_string(width) + ",height=" + std::to_string(height);
    std::string description = encoder + " name=e ! appsink name=out sync=false";
    description += source("color", "video/x-raw,format=RGB" + size);
    description += source("depth", "video/x-raw,format=GRAY16_LE" + size + depth_caps);
    if (further.stack)
        description +=
            source("stack", "video/x-focal-stack,format=RGB,planes=" + std::to_string(further.planes) + size);
    if (further.uncertainty)
        description += source("uncertainty", "video/x-raw,format=GRAY16_LE" + size + depth_caps);
    g_autoptr(GError) error = nullptr;
    g_autoptr(GstElement) pipeline = gst_parse_launch(description.c_str(), &error);
    if (error)
        return {{}, error->message};
    EncodedFile file;
    if (gst_element_set_state(pipeline, GST_STATE_PLAYING) != GST_STATE_CHANGE_FAILURE) {
        feed(pipeline, "color", std::move(colour));
        feed(pipeline, "depth", std::move(depth));
        if (further.stack)
            feed(pipeline, "stack", std::move(further.stack));
        if (further.uncertainty)
            feed(pipeline, "uncertainty", std::move(further.uncertainty));
        file.bytes = pull(pipeline);
    }
    file.error = first_error(pipeline);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    return file;
}

} // namespace dff
