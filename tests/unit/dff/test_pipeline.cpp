/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_pipeline.h"

#include <fstream>
#include <gtest/gtest.h>

namespace dff {

namespace {

void ensure_gst()
{
    static const bool once = [] {
        gst_init(nullptr, nullptr);
        return true;
    }();
    (void)once;
}

Outcome wait_for_end(GstElement *pipeline, GstClockTime timeout)
{
    Outcome outcome;
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline);
    const auto types = static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR | GST_MESSAGE_WARNING);
    const gint64 deadline = g_get_monotonic_time() + static_cast<gint64>(timeout / GST_USECOND);
    while (!outcome.end_of_stream && outcome.error.empty()) {
        const gint64 left = deadline - g_get_monotonic_time();
        if (left <= 0)
            return outcome;
        g_autoptr(GstMessage) message =
            gst_bus_timed_pop_filtered(bus, static_cast<GstClockTime>(left) * GST_USECOND, types);
        if (!message)
            return outcome;
        g_autoptr(GError) error = nullptr;
        if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS) {
            outcome.end_of_stream = true;
        } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
            gst_message_parse_error(message, &error, nullptr);
            outcome.error = error->message;
        } else if (outcome.warning.empty()) {
            gst_message_parse_warning(message, &error, nullptr);
            outcome.warning = error->message;
        }
    }
    return outcome;
}

} // namespace

Outcome run(const std::string &description, unsigned seconds)
{
    ensure_gst();
    g_autoptr(GError) error = nullptr;
    g_autoptr(GstElement) pipeline = gst_parse_launch(description.c_str(), &error);
    if (error)
        return {.end_of_stream = false, .error = error->message, .warning = {}};
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    Outcome outcome = wait_for_end(pipeline, seconds * GST_SECOND);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    return outcome;
}

TestPipeline::TestPipeline(const std::string &description)
{
    ensure_gst();
    g_autoptr(GError) error = nullptr;
    pipeline_ = gst_parse_launch(description.c_str(), &error);
    EXPECT_EQ(error, nullptr) << error->message;
}

TestPipeline::~TestPipeline()
{
    gst_element_set_state(pipeline_, GST_STATE_NULL);
    for (GstElement *element : elements_)
        gst_object_unref(element);
    gst_object_unref(pipeline_);
}

GstElement *TestPipeline::element(const char *name) const
{
    GstElement *element = gst_bin_get_by_name(GST_BIN(pipeline_), name);
    EXPECT_NE(element, nullptr) << name;
    elements_.push_back(element);
    return element;
}

GstSample *TestPipeline::pull(const char *sink) const
{
    GstSample *sample = nullptr;
    g_signal_emit_by_name(element(sink), "try-pull-sample", 30 * GST_SECOND, &sample);
    return sample;
}

std::vector<GstSample *> TestPipeline::pull_all(const char *sink) const
{
    std::vector<GstSample *> samples;
    while (GstSample *sample = pull(sink))
        samples.push_back(sample);
    return samples;
}

Outcome TestPipeline::wait() const
{
    return wait_for_end(pipeline_, 30 * GST_SECOND);
}

std::string write_file(const std::string &name, const std::vector<guint8> &bytes)
{
    const std::string path = testing::TempDir() + name + "." + std::to_string(getpid());
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char *>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return path;
}

std::vector<guint8> gray_stack(unsigned width, unsigned height, unsigned planes, unsigned sharp)
{
    const unsigned stride = (width + 3) / 4 * 4;
    std::vector<guint8> stack(size_t{stride} * height * planes, 120);
    guint32 random = 1;
    for (unsigned y = 0; y < height && sharp < planes; y++)
        for (unsigned x = 0; x < width; x++) {
            random = random * 1664525 + 1013904223;
            stack[(size_t{sharp} * height + y) * stride + x] = 60 + (random >> 25);
        }
    return stack;
}

} // namespace dff
