/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-lenssweepsrc
 * @title: lenssweepsrc
 * @short_description: planes of a GenICam camera behind a swept lens
 *
 * Takes a GigE Vision or USB3 Vision camera, the lens before it and the sequencer that keeps them in step,
 * and gives the planes of their sweeps: each buffer is one frame with its #GstFocusMeta. A frame that may
 * have a wrong plane number is dropped instead, counted in `stats` and told in a QoS message.
 *
 * How the plane of a frame is known depends on `trigger`:
 *
 * - `line` with `sync-line`: the frames' numbers, the camera's clock, the arrival of the frames and the edges
 * of the sync line must agree about it. If they do not, the rest of that sweep is dropped; labels come again
 * with the next edge. The first sweep (three, if neither `run-line` nor the lens starts the sequencer) shows
 * which frame is of which edge and is dropped.
 * - `line` without `sync-line`: the first frame after the sequencer was started is plane 0, then the frames'
 * numbers and the time between them must agree. If they do not, the sequencer is stopped and started again by
 * `run-line` or the lens; where neither is there, that is an error, since nobody can tell which plane comes
 * next.
 * - `software`: this element moves the lens, waits until it rests, and tells the camera to expose. Numbers,
 * times and commands must agree.
 * - `free-run`: nothing moves in step; frames are counted, those that were lost by their numbers.
 * sweep begins.
 *
 * Silence of the trigger is no error, unless `trigger-timeout` says so. A camera that does not answer any
 * more ends the stream with an error; set the pipeline to NULL and PLAYING again when it is back. Buffers
 * stay valid after that, and after the end of the pipeline.
 *
 * The PTS is the running time at which the exposure began. The camera's own clock is in a
 * #GstReferenceTimestampMeta with the caps `timestamp/x-ptp` if it follows PTP, else `timestamp/x-camera`.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 lenssweepsrc camera=Fake_1 trigger=free-run rate=5 num-buffers=24 ! focalstackmux ! fakesink
 * ]| A camera that Aravis simulates. With a real one and a sequencer: `lenssweepsrc lens=fpga:/dev/i2c-1@0x3c
 * run-line=gpiochip0:5 sync-line=gpiochip0:6 near=5 far=0`.
 */
#include "lenssweepsrc.h"

#include "camera_properties.h"
#include "plane_buffer.h"

#include <atomic>
#include <cmath>
#include <exception>
#include <gst/video/video.h>
#include <memory>

GST_DEBUG_CATEGORY_STATIC(gst_lens_sweep_src_debug);
#define GST_CAT_DEFAULT gst_lens_sweep_src_debug

struct GstLensSweepSrcState {
    /* Guarded by the object lock, within which nothing is locked but the capture's own mutexes. */
    CameraProperties properties;
    bool changed = false;      /* rate, exposure or gain, while running */
    dff::CaptureCounts counts; /* as of the last frame */
    guint64 delivered = 0;
    GstClockTime latency = GST_CLOCK_TIME_NONE;
    GstClockTime max_latency = GST_CLOCK_TIME_NONE;
    std::shared_ptr<dff::SweepCapture> capture; /* the pointer; set by start() and stop() */

    std::atomic<bool> flushing = false;
    std::atomic<gint64> playing_since_ns = 0; /* frames that arrived before are stale */

    /* The streaming thread's alone, between start() and stop(). */
    dff::CaptureSettings settings;
    CameraFormat format;
    bool running = false;
    guint64 missing = 0; /* planes that were reported */
    GstCaps *clock_caps = nullptr;
};

struct _GstLensSweepSrc {
    GstPushSrc parent;
    GstLensSweepSrcState *state;
};

G_DEFINE_FINAL_TYPE(GstLensSweepSrc, gst_lens_sweep_src, GST_TYPE_PUSH_SRC)
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(lenssweepsrc, "lenssweepsrc", GST_RANK_NONE, GST_TYPE_LENS_SWEEP_SRC,
                                      GST_DEBUG_CATEGORY_INIT(gst_lens_sweep_src_debug, "lenssweepsrc", 0,
                                                              "camera behind a swept lens"))

static void post_error(GstLensSweepSrc *self, const std::exception &error)
{
    if (dynamic_cast<const std::invalid_argument *>(&error))
        GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("The properties cannot be used: %s.", error.what()),
                          (nullptr));
    else
        GST_ELEMENT_ERROR(self, RESOURCE, FAILED, ("%s", error.what()), ("camera, lens or line"));
}

static void put_capture(GstLensSweepSrc *self, std::shared_ptr<dff::SweepCapture> capture)
{
    GST_OBJECT_LOCK(self);
    self->state->capture.swap(capture);
    GST_OBJECT_UNLOCK(self);
}

static void warn_of_blind_labels(GstLensSweepSrc *self, const dff::CaptureSettings &settings)
{
    const bool started_here = !settings.run_line.empty() || settings.lens.starts_with("fpga:");
    if (settings.trigger == dff::TriggerKind::Line && settings.sync_line.empty() && !started_here)
        GST_ELEMENT_WARNING(
            self, RESOURCE, SETTINGS,
            ("Nothing tells which plane the first trigger is of; it is taken for plane 0. Set "
             "sync-line or run-line."),
            (nullptr));
}

static gboolean start(GstBaseSrc *source)
{
    auto *self = GST_LENS_SWEEP_SRC(source);
    GstLensSweepSrcState &state = *self->state;
    GST_OBJECT_LOCK(self);
    const CameraProperties properties = state.properties;
    state.changed = false;
    state.counts = {};
    state.delivered = 0;
    GST_OBJECT_UNLOCK(self);
    state.format = {};
    state.running = false;
    state.missing = 0;
    try {
        state.settings = properties.settings();
        auto capture = std::make_shared<dff::SweepCapture>(state.settings);
        GST_INFO_OBJECT(self, "camera %s", capture->camera().title().c_str());
        state.clock_caps = capture->camera().has_ptp()
                               ? gst_caps_from_string("timestamp/x-ptp,version=IEEE1588-2008,domain=0")
                               : gst_caps_new_empty_simple("timestamp/x-camera");
        put_capture(self, std::move(capture));
    } catch (const std::exception &error) {
        post_error(self, error);
        return FALSE;
    }
    warn_of_blind_labels(self, state.settings);
    return TRUE;
}

static gboolean stop(GstBaseSrc *source)
{
    auto *self = GST_LENS_SWEEP_SRC(source);
    put_capture(self, nullptr);
    gst_clear_caps(&self->state->clock_caps);
    return TRUE;
}

static gboolean unlock(GstBaseSrc *source)
{
    auto *self = GST_LENS_SWEEP_SRC(source);
    self->state->flushing = true;
    GST_OBJECT_LOCK(self);
    if (self->state->capture)
        self->state->capture->interrupt();
    GST_OBJECT_UNLOCK(self);
    return TRUE;
}

static gboolean unlock_stop(GstBaseSrc *source)
{
    GST_LENS_SWEEP_SRC(source)->state->flushing = false;
    return TRUE;
}

/* Called by the state change and the streaming thread, and by queries of others while the camera is open. */
static GstCaps *get_caps(GstBaseSrc *source, GstCaps *filter)
{
    auto *self = GST_LENS_SWEEP_SRC(source);
    GstCaps *caps = nullptr;
    GST_OBJECT_LOCK(self);
    const double frame_rate = self->state->properties.capture.rate * self->state->settings.plan.planes();
    const auto capture = self->state->capture; /* stop() may be called meanwhile */
    GST_OBJECT_UNLOCK(self);
    try {
        caps = capture ? camera_caps(capture->camera(), frame_rate) : camera_template_caps();
    } catch (const std::exception &error) {
        post_error(self, error);
        return gst_caps_new_empty();
    }
    if (filter) {
        GstCaps *all = caps;
        caps = gst_caps_intersect_full(filter, all, GST_CAPS_INTERSECT_FIRST);
        gst_caps_unref(all);
    }
    return caps;
}

static GstCaps *fixate(GstBaseSrc *source, GstCaps *caps)
{
    auto *self = GST_LENS_SWEEP_SRC(source);
    try {
        return fixate_camera_caps(self->state->capture->camera(), caps);
    } catch (const std::exception &error) {
        post_error(self, error);
        return gst_caps_fixate(caps);
    }
}

static void warn_of_odd_size(GstLensSweepSrc *self, const CameraFormat &format)
{
    const dff::CameraRegion region = self->state->capture->camera().region();
    const bool odd = region.width % 2 != 0 || region.height % 2 != 0;
    if (odd && format.layout->is_bayer())
        GST_ELEMENT_WARNING(
            self, STREAM, FORMAT,
            ("The camera's picture is %dx%d; a Bayer pattern needs even sizes, so it is %dx%d now.",
             region.width, region.height, format.width, format.height),
            (nullptr));
}

static gboolean set_caps(GstBaseSrc *source, GstCaps *caps)
{
    auto *self = GST_LENS_SWEEP_SRC(source);
    GstLensSweepSrcState &state = *self->state;
    try {
        const CameraFormat format = format_of_caps(state.capture->camera(), caps);
        if (!format.layout)
            return FALSE;
        if (format == state.format)
            return TRUE; /* only the frame rate is another */
        warn_of_odd_size(self, format);
        state.format = format;
        state.running = false;
    } catch (const std::exception &error) {
        post_error(self, error);
        return FALSE;
    }
    return TRUE;
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

/* False if nothing downstream takes the new frame rate. */
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
    const bool rate_changed = settings.rate != state.settings.rate;
    state.capture->change(settings);
    state.settings.rate = settings.rate;
    state.settings.exposure_us = settings.exposure_us;
    check_load(self);
    tell_latency(self);
    if (!rate_changed)
        return true;
    g_autoptr(GstCaps) caps = gst_pad_get_current_caps(GST_BASE_SRC_PAD(self));
    caps = gst_caps_make_writable(caps);
    gint numerator = 0;
    gint denominator = 1;
    gst_util_double_to_fraction(settings.frame_rate(), &numerator, &denominator);
    gst_caps_set_simple(caps, "framerate", GST_TYPE_FRACTION, numerator, denominator, nullptr);
    return gst_base_src_set_caps(GST_BASE_SRC(self), caps);
}

/* The running time of a moment of CLOCK_MONOTONIC; none before the pipeline's base time. */
static GstClockTime running_time_of(GstLensSweepSrc *self, gint64 host_ns)
{
    g_autoptr(GstClock) clock = gst_element_get_clock(GST_ELEMENT(self));
    if (!clock)
        return GST_CLOCK_TIME_NONE;
    const auto now = static_cast<gint64>(gst_clock_get_time(clock));
    const gint64 moment = now - (dff::host_now_ns() - host_ns);
    const auto base = static_cast<gint64>(gst_element_get_base_time(GST_ELEMENT(self)));
    return moment < base ? GST_CLOCK_TIME_NONE : static_cast<GstClockTime>(moment - base);
}

/* Publishes the counts; a QoS message for planes that are missing. */
static void report(GstLensSweepSrc *self)
{
    GstLensSweepSrcState &state = *self->state;
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

static GstBuffer *make_buffer(GstLensSweepSrc *self, dff::CapturedPlane plane)
{
    GstLensSweepSrcState &state = *self->state;
    const dff::SweepCapture &capture = *state.capture;
    const GstClockTime pts = running_time_of(self, plane.exposed_ns);
    if (plane.frame.arrival_ns < state.playing_since_ns || !GST_CLOCK_TIME_IS_VALID(pts))
        return nullptr; /* of a time when the pipeline did not play */
    const PlaneOutput output{
        state.format,
        capture.plan().planes(),
        capture.calibrated() ? capture.plan().power(plane.plane) : NAN,
        capture.code(plane.plane),
        static_cast<GstClockTime>(state.settings.exposure_us * 1000),
        static_cast<GstClockTime>(1e9 / state.settings.frame_rate()),
        state.clock_caps,
    };
    GstBuffer *buffer = plane_buffer(std::move(plane), output);
    if (buffer)
        GST_BUFFER_PTS(buffer) = pts;
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

/* One step: a buffer, or null if none is there yet. */
static GstFlowReturn step(GstLensSweepSrc *self, GstBuffer **buffer)
{
    GstLensSweepSrcState &state = *self->state;
    run(self);
    if (!take_changes(self))
        return GST_FLOW_NOT_NEGOTIATED;
    const gint64 deadline = deadline_of(self);
    if (dff::host_now_ns() >= deadline) {
        GST_ELEMENT_ERROR(
            self, RESOURCE, READ,
            ("No frame came within trigger-timeout. Check that the sequencer runs and is wired to the "
             "camera's %s.",
             state.settings.trigger_source.c_str()),
            (nullptr));
        return GST_FLOW_ERROR;
    }
    auto plane = state.capture->next(deadline);
    report(self);
    if (plane)
        *buffer = make_buffer(self, std::move(*plane));
    return GST_FLOW_OK;
}

static GstFlowReturn create(GstPushSrc *source, GstBuffer **buffer)
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
        post_error(self, error);
        return GST_FLOW_ERROR;
    }
    GST_OBJECT_LOCK(self);
    GST_BUFFER_OFFSET(*buffer) = state.delivered++;
    GST_BUFFER_OFFSET_END(*buffer) = state.delivered;
    GST_OBJECT_UNLOCK(self);
    return GST_FLOW_OK;
}

static gboolean query(GstBaseSrc *source, GstQuery *query)
{
    auto *self = GST_LENS_SWEEP_SRC(source);
    if (GST_QUERY_TYPE(query) != GST_QUERY_LATENCY)
        return GST_BASE_SRC_CLASS(gst_lens_sweep_src_parent_class)->query(source, query);
    GST_OBJECT_LOCK(self);
    const dff::CaptureSettings &settings = self->state->properties.capture;
    const double period_us = 1e6 / (settings.rate * self->state->properties.sweep.planes);
    const auto expected = static_cast<GstClockTime>((settings.exposure_us + period_us) * 1000);
    const bool known = GST_CLOCK_TIME_IS_VALID(self->state->latency);
    gst_query_set_latency(query, TRUE, known ? self->state->latency : expected, self->state->max_latency);
    GST_OBJECT_UNLOCK(self);
    return TRUE;
}

static GstStateChangeReturn change_state(GstElement *element, GstStateChange transition)
{
    auto *self = GST_LENS_SWEEP_SRC(element);
    if (transition == GST_STATE_CHANGE_PAUSED_TO_PLAYING)
        self->state->playing_since_ns = dff::host_now_ns();
    return GST_ELEMENT_CLASS(gst_lens_sweep_src_parent_class)->change_state(element, transition);
}

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *pspec)
{
    auto *self = GST_LENS_SWEEP_SRC(object);
    GST_OBJECT_LOCK(self);
    const bool known = set_camera_property(self->state->properties, id, value);
    self->state->changed = true;
    if (self->state->capture)
        self->state->capture->interrupt();
    GST_OBJECT_UNLOCK(self);
    if (!known)
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    auto *self = GST_LENS_SWEEP_SRC(object);
    GST_OBJECT_LOCK(self);
    bool known = true;
    if (id == PROP_STATS)
        g_value_take_boxed(value, capture_stats(self->state->counts, self->state->delivered));
    else
        known = get_camera_property(self->state->properties, id, value);
    GST_OBJECT_UNLOCK(self);
    if (!known)
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void finalize(GObject *object)
{
    delete GST_LENS_SWEEP_SRC(object)->state;
    G_OBJECT_CLASS(gst_lens_sweep_src_parent_class)->finalize(object);
}

static void gst_lens_sweep_src_init(GstLensSweepSrc *self)
{
    self->state = new GstLensSweepSrcState;
    gst_base_src_set_live(GST_BASE_SRC(self), TRUE);
    gst_base_src_set_format(GST_BASE_SRC(self), GST_FORMAT_TIME);
}

static void gst_lens_sweep_src_class_init(GstLensSweepSrcClass *klass)
{
    auto *object_class = G_OBJECT_CLASS(klass);
    auto *element_class = GST_ELEMENT_CLASS(klass);
    auto *source_class = GST_BASE_SRC_CLASS(klass);

    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->finalize = finalize;
    install_camera_properties(object_class);
    g_object_class_install_property(
        object_class, PROP_STATS,
        g_param_spec_boxed(
            "stats", "Statistics",
            "Frames since the start: delivered, lost (of those incomplete, and underruns), doubled, "
            "unlabelled; disagreements, dropped-sweeps, wrong-edges, restarts",
            GST_TYPE_STRUCTURE, static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));

    element_class->change_state = change_state;
    source_class->start = start;
    source_class->stop = stop;
    source_class->unlock = unlock;
    source_class->unlock_stop = unlock_stop;
    source_class->get_caps = get_caps;
    source_class->fixate = fixate;
    source_class->set_caps = set_caps;
    source_class->query = query;
    GST_PUSH_SRC_CLASS(klass)->create = create;

    g_autoptr(GstCaps) caps = camera_template_caps();
    gst_element_class_add_pad_template(element_class,
                                       gst_pad_template_new("src", GST_PAD_SRC, GST_PAD_ALWAYS, caps));
    gst_element_class_set_static_metadata(element_class, "Swept camera", "Source/Video/Hardware",
                                          "Planes of a GenICam camera behind a swept lens",
                                          "the gst-plugins-dff authors");
    mark_camera_types();
}
