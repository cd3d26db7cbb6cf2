/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "receiver.h"

#include <stdexcept>

namespace {

constexpr GstClockTime patience = 30 * GST_SECOND;

} // namespace

Receiver::Receiver(const std::string &launch)
{
    g_autoptr(GError) error = nullptr;
    pipeline_ = gst_parse_launch_full(launch.c_str(), nullptr, GST_PARSE_FLAG_FATAL_ERRORS, &error);
    if (!pipeline_)
        throw std::runtime_error(error->message);
    gst_object_ref_sink(pipeline_);
    gst_element_set_state(pipeline_, GST_STATE_PLAYING);
}

Receiver::~Receiver()
{
    gst_element_set_state(pipeline_, GST_STATE_NULL);
    gst_object_unref(pipeline_);
    for (const auto &[name, sample] : last_)
        if (sample)
            gst_sample_unref(sample);
}

GstSample *Receiver::next(const std::string &sink)
{
    GstElement *appsink = gst_bin_get_by_name(GST_BIN(pipeline_), sink.c_str());
    GstSample *sample = gst_app_sink_try_pull_sample(GST_APP_SINK(appsink), patience);
    gst_object_unref(appsink);
    GstSample *&last = last_[sink];
    if (last)
        gst_sample_unref(last);
    last = sample;
    return sample;
}

GstBuffer *Receiver::next_buffer(const std::string &sink)
{
    GstSample *sample = next(sink);
    return sample ? gst_sample_get_buffer(sample) : nullptr;
}

std::string Receiver::error()
{
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline_);
    g_autoptr(GstMessage) message = gst_bus_timed_pop_filtered(bus, patience, GST_MESSAGE_ERROR);
    if (!message)
        return "";
    g_autoptr(GError) error = nullptr;
    g_autofree char *details = nullptr;
    gst_message_parse_error(message, &error, &details);
    return std::string(error->message) + " " + (details ? details : "");
}
