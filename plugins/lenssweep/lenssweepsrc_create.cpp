/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lenssweepsrc_private.h"
#include "monotonic_lead.h"

#include <algorithm>
#include <cmath>
#include <utility>

void gst_lens_sweep_src_post_error(GstLensSweepSrc *self, const std::exception &error)
{
    if (dynamic_cast<const std::invalid_argument *>(&error))
        GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("The properties cannot be used: %s.", error.what()),
                          (nullptr));
    else
        GST_ELEMENT_ERROR(self, RESOURCE, FAILED, ("%s", error.what()), ("camera, lens or line"));
}

static void tell_latency(GstLensSweepSrc *self)
{
    const dff::SweepCapture &capture = *self->state->capture;
    const auto period = static_cast<GstClockTime>(1e9 / self->state->settings.frame_rate());
    GST_OBJECT_LOCK(self);
    const GstClockTime before = self->state->latency;
    self->state->latency = static_cast<GstClockTime>(capture.latency_ns());
    self->state->max_latency = self->state->latency + capture.buffers() * period;
    const bool other = before != self->state->latency;
    GST_OBJECT_UNLOCK(self);
    if (other)
        gst_element_post_message(GST_ELEMENT(self), gst_message_new_latency(GST_OBJECT(self)));
}

static void check_load(GstLensSweepSrc *self)
{
    const dff::LinkLoad load = self->state->capture->load();
    GST_INFO_OBJECT(self, "%s", dff::describe(load).c_str());
    const std::string complaint = dff::complaint(load);
    if (!complaint.empty())
        GST_ELEMENT_WARNING(self, RESOURCE, SETTINGS, ("%s", complaint.c_str()), (nullptr));
}

/* The camera acquires from the first create() on, not before PLAYING. */
static void run(GstLensSweepSrc *self)
{
    GstLensSweepSrcState &state = *self->state;
    if (state.running)
        return;
    state.capture->start(*state.format.layout, state.format.width, state.format.height);
    state.running = true;
    check_load(self);
    tell_latency(self);
}

/* Compared with what the caps say and not with the rate before: they may have been negotiated for a rate that
 * was set and taken back since. False if nothing downstream takes it, which is an error, or if the stream
 * ends just now. */
static bool tell_frame_rate(GstLensSweepSrc *self, double frame_rate)
{
    gint numerator = 0;
    gint denominator = 1;
    gst_util_double_to_fraction(frame_rate, &numerator, &denominator);
    g_auto(GValue) fraction = G_VALUE_INIT;
    g_value_init(&fraction, GST_TYPE_FRACTION);
    gst_value_set_fraction(&fraction, numerator, denominator);

    g_autoptr(GstCaps) caps = gst_pad_get_current_caps(GST_BASE_SRC_PAD(self));
    const GValue *told = gst_structure_get_value(gst_caps_get_structure(caps, 0), "framerate");
    if (told && gst_value_compare(told, &fraction) == GST_VALUE_EQUAL)
        return true;
    return gst_base_src_negotiate(GST_BASE_SRC(self));
}

/* False if the stream cannot go on with them. */
static bool take_changes(GstLensSweepSrc *self)
{
    GstLensSweepSrcState &state = *self->state;
    GST_OBJECT_LOCK(self);
    const bool changed = std::exchange(state.changed, false);
    dff::CaptureSettings settings = state.properties.capture;
    GST_OBJECT_UNLOCK(self);
    if (!changed)
        return true;
    settings.plan = state.settings.plan;
    GST_INFO_OBJECT(self, "rate %g sweeps a second, exposure %g us", settings.rate, settings.exposure_us);
    state.capture->change(settings);
    GST_OBJECT_LOCK(self);
    state.settings.rate = settings.rate;
    state.settings.exposure_us = settings.exposure_us;
    GST_OBJECT_UNLOCK(self);
    check_load(self);
    tell_latency(self);
    return tell_frame_rate(self, settings.frame_rate());
}

/* The running time of a moment of CLOCK_MONOTONIC; none before the pipeline's base time. */
static GstClockTime running_time_of(GstLensSweepSrc *self, gint64 host_ns)
{
    g_autoptr(GstClock) clock = gst_element_get_clock(GST_ELEMENT(self));
    if (!clock)
        return GST_CLOCK_TIME_NONE;
    const gint64 moment = host_ns - monotonic_lead(clock);
    const auto base = static_cast<gint64>(gst_element_get_base_time(GST_ELEMENT(self)));
    return moment < base ? GST_CLOCK_TIME_NONE : static_cast<GstClockTime>(moment - base);
}

/* Publishes the counts; a QoS message for planes that are missing, a warning of what goes wrong although the
 * stream goes on. */
static void report(GstLensSweepSrc *self)
{
    GstLensSweepSrcState &state = *self->state;
    const std::string complaint = state.capture->take_complaint();
    if (!complaint.empty())
        GST_ELEMENT_WARNING(self, RESOURCE, READ, ("%s", complaint.c_str()), (nullptr));
    const dff::CaptureCounts counts = state.capture->counts();
    GST_OBJECT_LOCK(self);
    state.counts = counts;
    const guint64 delivered = state.delivered;
    GST_OBJECT_UNLOCK(self);
    const guint64 missing = missing_planes(counts);
    if (missing > state.missing) {
        const GstClockTime now = running_time_of(self, dff::host_now_ns());
        GstMessage *message = gst_message_new_qos(GST_OBJECT(self), TRUE, now, now, now, GST_CLOCK_TIME_NONE);
        gst_message_set_qos_stats(message, GST_FORMAT_BUFFERS, delivered, missing);
        gst_element_post_message(GST_ELEMENT(self), message);
    }
    state.missing = missing;
}

static double power_of(const GstLensSweepSrcState &state, unsigned plane)
{
    if (!state.calibrated_powers.empty())
        return state.calibrated_powers.at(plane);
    return state.capture->calibrated() ? state.capture->plan().power(plane) : NAN;
}

static GstBuffer *make_buffer(GstLensSweepSrc *self, dff::CapturedPlane plane)
{
    GstLensSweepSrcState &state = *self->state;
    const dff::SweepCapture &capture = *state.capture;
    const GstClockTime arrived = running_time_of(self, plane.frame.arrival_ns);
    if (plane.frame.arrival_ns < state.playing_since_ns || !GST_CLOCK_TIME_IS_VALID(arrived))
        return nullptr; /* of a time when the pipeline did not play */
    /* A camera that triggers itself may have begun before. */
    const auto since_exposure =
        static_cast<GstClockTime>(std::max<gint64>(plane.frame.arrival_ns - plane.exposed_ns, 0));
    const PlaneOutput output{
        state.format,
        capture.plan().planes(),
        power_of(state, plane.plane),
        capture.code(plane.plane),
        static_cast<GstClockTime>(state.settings.exposure_us * 1000),
        static_cast<GstClockTime>(1e9 / state.settings.frame_rate()),
        state.clock_caps,
    };
    GstBuffer *buffer = plane_buffer(std::move(plane), output);
    if (buffer)
        GST_BUFFER_PTS(buffer) = arrived - std::min(arrived, since_exposure);
    return buffer;
}

static gint64 deadline_of(GstLensSweepSrc *self)
{
    GST_OBJECT_LOCK(self);
    const GstClockTime timeout = self->state->properties.trigger_timeout;
    GST_OBJECT_UNLOCK(self);
    const gint64 last = self->state->capture->last_frame_ns();
    return timeout > static_cast<GstClockTime>(G_MAXINT64 - last) ? G_MAXINT64
                                                                  : last + static_cast<gint64>(timeout);
}

/* Where to look when no frame comes. */
static std::string advice_on_silence(const dff::CaptureSettings &settings)
{
    switch (settings.trigger) {
    case dff::TriggerKind::Line:
        return "the sequencer runs and is wired to the camera's " + settings.trigger_source;
    case dff::TriggerKind::Software:
        return "the camera takes software triggers, and as many as planes times rate";
    case dff::TriggerKind::FreeRun:
        break;
    }
    return "trigger-timeout leaves time for a frame, and the camera sends any with arv-camera-test-0.8";
}

/* One step: a buffer, or null if none is there yet. */
static GstFlowReturn step(GstLensSweepSrc *self, GstBuffer **buffer)
{
    GstLensSweepSrcState &state = *self->state;
    run(self);
    if (!take_changes(self))
        return GST_FLOW_NOT_NEGOTIATED;
    if (!state.running) /* caps of another format came with the new frame rate */
        return GST_FLOW_OK;
    const gint64 deadline = deadline_of(self);
    if (dff::host_now_ns() >= deadline) {
        GST_ELEMENT_ERROR(self, RESOURCE, READ,
                          ("No frame came within trigger-timeout. Check that %s.",
                           advice_on_silence(state.settings).c_str()),
                          (nullptr));
        return GST_FLOW_ERROR;
    }
    auto plane = state.capture->next(deadline);
    report(self);
    if (plane)
        *buffer = make_buffer(self, std::move(*plane));
    return GST_FLOW_OK;
}

GstFlowReturn gst_lens_sweep_src_create(GstPushSrc *source, GstBuffer **buffer)
{
    auto *self = GST_LENS_SWEEP_SRC(source);
    GstLensSweepSrcState &state = *self->state;
    *buffer = nullptr;
    try {
        while (!*buffer) {
            if (state.flushing)
                return GST_FLOW_FLUSHING;
            const GstFlowReturn flow = step(self, buffer);
            if (flow != GST_FLOW_OK)
                return flow;
        }
    } catch (const std::exception &error) {
        gst_lens_sweep_src_post_error(self, error);
        return GST_FLOW_ERROR;
    }
    GST_OBJECT_LOCK(self);
    GST_BUFFER_OFFSET(*buffer) = state.delivered++;
    GST_BUFFER_OFFSET_END(*buffer) = state.delivered;
    GST_OBJECT_UNLOCK(self);
    return GST_FLOW_OK;
}
