/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "source_pipeline.h"

#include "log.h"

#include <gst/app/app.h>
#include <gst/dff/dff.h>
#include <stdexcept>
#include <utility>

namespace dff {

namespace {

constexpr const char *output_names[] = {"depth", "uncertainty", "aif", "planes"};

/* Frames that may wait while the one before is handed out, which takes no longer than copying its metas. */
constexpr unsigned waiting_frames = 4;

GstElement *make(const char *factory)
{
    if (GstElement *element = gst_element_factory_make(factory, nullptr))
        return element;
    throw std::invalid_argument(std::string("There is no element ") + factory +
                                ": install gstreamer1.0-plugins-base");
}

std::string text_of(const GError *error, const char *details)
{
    return std::string(error->message) + (details ? std::string(" (") + details + ")" : "");
}

} // namespace

SourcePipeline::SourcePipeline(const std::string &launch)
    : pipeline_(GST_PIPELINE(gst_object_ref_sink(gst_pipeline_new(nullptr))))
{
    g_autoptr(GError) error = nullptr;
    GstElement *capture = gst_dff_capture_new(launch.c_str(), &error);
    if (!capture)
        throw std::invalid_argument(error->message);
    gst_bin_add(GST_BIN(pipeline_.get()), capture);
    for (const char *name : output_names)
        if (const ObjectPointer<GstPad> pad{gst_element_get_static_pad(capture, name)})
            add_output(name, pad.get());
    const ObjectPointer<GstClock> clock(gst_system_clock_obtain());
    gst_pipeline_use_clock(pipeline_.get(), clock.get());
}

SourcePipeline::~SourcePipeline()
{
    gst_element_set_state(GST_ELEMENT(pipeline_.get()), GST_STATE_NULL);
    if (bus_watch_) {
        g_source_destroy(bus_watch_);
        g_source_unref(bus_watch_);
    }
}

void SourcePipeline::add_output(const std::string &name, GstPad *pad)
{
    GstElement *queue = make("queue");
    GstElement *sink = make("appsink");
    g_object_set(queue, "max-size-buffers", waiting_frames, "max-size-bytes", 0, "max-size-time", guint64{0},
                 nullptr);
    g_object_set(sink, "max-buffers", 1, nullptr);
    gst_bin_add_many(GST_BIN(pipeline_.get()), queue, sink, nullptr);
    gst_element_link(queue, sink);
    const ObjectPointer<GstPad> queue_pad(gst_element_get_static_pad(queue, "sink"));
    if (gst_pad_link(pad, queue_pad.get()) != GST_PAD_LINK_OK)
        throw std::invalid_argument("The output " + name + " of the source pipeline cannot be linked");
    GST_INFO("The output %s is %s:%s", name.c_str(), GST_DEBUG_PAD_NAME(pad));
    sinks_[name] = share(sink);
    outputs_.insert(name);

    Tap &tap = taps_[name];
    tap = {this, name};
    GstAppSinkCallbacks callbacks = {};
    callbacks.new_sample = [](GstAppSink *app_sink, gpointer data) {
        const auto *self = static_cast<Tap *>(data);
        const SamplePointer sample(gst_app_sink_pull_sample(app_sink));
        return sample ? self->pipeline->take_sample(self->output, sample.get()) : GST_FLOW_EOS;
    };
    gst_app_sink_set_callbacks(GST_APP_SINK(sink), &callbacks, &tap, nullptr);
}

void SourcePipeline::start(GMainContext *context, OnFrame on_frame, OnEnd on_end)
{
    on_frame_ = std::move(on_frame);
    on_end_ = std::move(on_end);
    const ObjectPointer<GstBus> bus(gst_element_get_bus(GST_ELEMENT(pipeline_.get())));
    bus_watch_ = gst_bus_create_watch(bus.get());
    const GstBusFunc dispatch = [](GstBus *, GstMessage *message, gpointer self) -> gboolean {
        static_cast<SourcePipeline *>(self)->take_message(message);
        return G_SOURCE_CONTINUE;
    };
    g_source_set_callback(bus_watch_, G_SOURCE_FUNC(dispatch), this, nullptr);
    g_source_attach(bus_watch_, context);

    const bool live =
        gst_element_set_state(GST_ELEMENT(pipeline_.get()), GST_STATE_PAUSED) == GST_STATE_CHANGE_NO_PREROLL;
    GST_INFO("The source is %s", live ? "live" : "not live: it is slowed down to its frame rate");
    for (const auto &[name, sink] : sinks_)
        g_object_set(sink.get(), "sync", !live, nullptr);
    if (gst_element_set_state(GST_ELEMENT(pipeline_.get()), GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE)
        GST_ELEMENT_ERROR(pipeline_.get(), CORE, STATE_CHANGE, ("The source does not start."), (nullptr));
}

GstFlowReturn SourcePipeline::take_sample(const std::string &output, GstSample *sample)
{
    GstBuffer *buffer = gst_sample_get_buffer(sample);
    const GstSegment *segment = gst_sample_get_segment(sample);
    const GstClockTime base = gst_element_get_base_time(GST_ELEMENT(pipeline_.get()));
    GstClockTime running = GST_CLOCK_TIME_NONE;
    if (segment->format == GST_FORMAT_TIME)
        running = gst_segment_to_running_time(segment, GST_FORMAT_TIME, GST_BUFFER_PTS(buffer));
    const ObjectPointer<GstClock> clock(gst_pipeline_get_pipeline_clock(pipeline_.get()));
    const GstClockTime time =
        GST_CLOCK_TIME_IS_VALID(running) ? base + running : gst_clock_get_time(clock.get());
    on_frame_(output, {buffer, gst_sample_get_caps(sample), time, latency_});
    return GST_FLOW_OK;
}

void SourcePipeline::take_message(GstMessage *message)
{
    switch (GST_MESSAGE_TYPE(message)) {
    case GST_MESSAGE_ERROR: {
        g_autoptr(GError) error = nullptr;
        g_autofree char *details = nullptr;
        gst_message_parse_error(message, &error, &details);
        return end(text_of(error, details));
    }
    case GST_MESSAGE_EOS:
        return end("It came to its end");
    case GST_MESSAGE_LATENCY:
        gst_bin_recalculate_latency(GST_BIN(pipeline_.get()));
        [[fallthrough]];
    case GST_MESSAGE_ASYNC_DONE:
    case GST_MESSAGE_STATE_CHANGED: {
        g_autoptr(GstQuery) query = gst_query_new_latency();
        gboolean live = FALSE;
        GstClockTime least = 0;
        if (gst_element_query(GST_ELEMENT(pipeline_.get()), query)) {
            gst_query_parse_latency(query, &live, &least, nullptr);
            latency_ = live ? least : 0;
        }
        return;
    }
    default:
        return;
    }
}

void SourcePipeline::end(const std::string &reason)
{
    if (const OnEnd on_end = std::exchange(on_end_, nullptr))
        on_end(reason);
}

} // namespace dff
