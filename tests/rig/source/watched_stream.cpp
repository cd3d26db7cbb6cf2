/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "watched_stream.h"

#include "frame_stamp.h"

#include <future>
#include <gst/dff/dff.h>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace dff {

namespace {

struct Truth {
    uint32_t sweep;
    unsigned plane;
};

std::optional<Truth> read_stamp(GstBuffer *buffer)
{
    GstMapInfo map;
    if (!gst_buffer_map(buffer, &map, GST_MAP_READ))
        return std::nullopt;
    uint64_t stamp = 0;
    for (unsigned i = 0; i < stamp_pixels && i < map.size; i++)
        stamp = stamp << 1 | (map.data[i] > 127 ? 1 : 0);
    gst_buffer_unmap(buffer, &map);
    const Truth truth{static_cast<uint32_t>(stamp >> 16), static_cast<unsigned>(stamp >> 48 & 0xff)};
    if (frame_stamp(truth.sweep, static_cast<uint8_t>(truth.plane)) != stamp)
        return std::nullopt;
    return truth;
}

} // namespace

WatchedStream::WatchedStream(const std::string &pipeline)
{
    g_autoptr(GError) error = nullptr;
    pipeline_.reset(gst_parse_launch(pipeline.c_str(), &error));
    if (error)
        throw std::runtime_error(error->message);
    g_autoptr(GstElement) sink = gst_bin_get_by_name(GST_BIN(pipeline_.get()), "labels");
    if (!sink)
        return;
    GstAppSinkCallbacks callbacks{};
    callbacks.new_sample = &WatchedStream::new_sample;
    gst_app_sink_set_callbacks(GST_APP_SINK(sink), &callbacks, this, nullptr);
}

WatchedStream::~WatchedStream()
{
    stop();
}

void WatchedStream::play()
{
    {
        const std::scoped_lock lock(mutex_);
        true_sweeps_.clear();
    }
    gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
}

GstFlowReturn WatchedStream::new_sample(GstAppSink *sink, gpointer self)
{
    g_autoptr(GstSample) sample = gst_app_sink_pull_sample(sink);
    if (sample)
        static_cast<WatchedStream *>(self)->examine(sample);
    return GST_FLOW_OK;
}

void WatchedStream::examine(GstSample *sample)
{
    GstBuffer *buffer = gst_sample_get_buffer(sample);
    const GstFocusMeta *label = gst_buffer_get_focus_meta(buffer);
    const std::optional<Truth> truth = read_stamp(buffer);
    const std::scoped_lock lock(mutex_);
    watched_.frames++;
    watched_.exposure_ns = label ? label->exposure : 0;
    const GstStructure *caps = gst_caps_get_structure(gst_sample_get_caps(sample), 0);
    gst_structure_get_int(caps, "width", &watched_.width);
    gint numerator = 0;
    gint denominator = 1;
    gst_structure_get_fraction(caps, "framerate", &numerator, &denominator);
    watched_.frame_rate = static_cast<double>(numerator) / denominator;
    if (!label) {
        watched_.unlabelled++;
        return;
    }
    const auto known =
        truth ? true_sweeps_.try_emplace(label->sweep, truth->sweep).first : true_sweeps_.end();
    if (truth && label->plane == truth->plane && known->second == truth->sweep)
        return;
    if (watched_.wrong++ > 0)
        return;
    std::ostringstream text;
    text << "frame " << watched_.frames << " id " << label->frame_id << ": label " << label->sweep << '/'
         << label->plane;
    if (truth)
        text << ", truth " << truth->sweep << '/' << truth->plane << ", sweep seen as " << known->second;
    watched_.first_wrong = text.str();
}

Watched WatchedStream::watched() const
{
    const std::scoped_lock lock(mutex_);
    return watched_;
}

bool WatchedStream::stop_within(std::chrono::milliseconds time)
{
    std::promise<void> stopped;
    auto done = stopped.get_future();
    std::thread([promise = std::move(stopped), pipeline = gst_object_ref(pipeline_.get())]() mutable {
        gst_element_set_state(GST_ELEMENT(pipeline), GST_STATE_NULL);
        gst_object_unref(pipeline);
        promise.set_value();
    }).detach();
    return done.wait_for(time) == std::future_status::ready;
}

bool WatchedStream::wait_until(const std::function<bool(const Watched &)> &so,
                               std::chrono::milliseconds time) const
{
    const auto end = std::chrono::steady_clock::now() + time;
    while (!so(watched()) && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return so(watched());
}

bool WatchedStream::wait_for_frames(uint64_t count, std::chrono::milliseconds time) const
{
    return wait_until([count](const Watched &watched) { return watched.frames >= count; }, time);
}

void WatchedStream::wait_for_silence(std::chrono::milliseconds silence) const
{
    for (uint64_t before = watched().frames;; before = watched().frames) {
        std::this_thread::sleep_for(silence);
        if (watched().frames == before)
            return;
    }
}

std::optional<std::string> WatchedStream::wait_for_end(std::chrono::milliseconds time) const
{
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline_.get());
    g_autoptr(GstMessage) message =
        gst_bus_timed_pop_filtered(bus, static_cast<GstClockTime>(time.count()) * GST_MSECOND,
                                   static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS));
    if (!message)
        return std::nullopt;
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS)
        return "EOS";
    g_autoptr(GError) error = nullptr;
    gst_message_parse_error(message, &error, nullptr);
    return error->message;
}

std::string WatchedStream::stats() const
{
    g_autoptr(GstElement) source = gst_bin_get_by_name(GST_BIN(pipeline_.get()), "source");
    g_autoptr(GstStructure) stats = nullptr;
    g_object_get(source, "stats", &stats, nullptr);
    g_autofree gchar *text = stats ? gst_structure_to_string(stats) : g_strdup("none");
    return text;
}

uint64_t WatchedStream::stat(const char *name) const
{
    g_autoptr(GstElement) source = gst_bin_get_by_name(GST_BIN(pipeline_.get()), "source");
    g_autoptr(GstStructure) stats = nullptr;
    g_object_get(source, "stats", &stats, nullptr);
    guint64 value = UINT64_MAX;
    if (stats)
        gst_structure_get_uint64(stats, name, &value);
    return value;
}

} // namespace dff
