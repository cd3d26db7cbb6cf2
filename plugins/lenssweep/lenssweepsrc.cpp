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
 * which frame is of which edge and is dropped. With `lens=fpga:...` the number of triggers that the sequencer
 * has given, read over I2C in each sweep, must agree too; while it cannot be read, a warning says so and the
 * others decide alone.
 * - `line` without `sync-line`: the first frame after the sequencer was started is plane 0, then the frames'
 * numbers and the time between them must agree. If they do not, the sequencer is stopped and started again by
 * `run-line` or the lens; where neither is there, that is an error, since nobody can tell which plane comes
 * next.
 * - `software`: this element moves the lens, waits until it rests, and tells the camera to expose. Numbers,
 * times and commands must agree.
 * - `free-run`: nothing moves in step; frames are counted, those that were lost by their numbers.
 *
 * Silence of the trigger is no error, unless `trigger-timeout` says so. Frames that come and whose planes
 * cannot be told, or sweeps that are dropped in a row, are told in a warning, once a cause. A camera that
 * does not answer any more ends the stream with an error; set the pipeline to NULL and PLAYING again when it
 * is back. Buffers stay valid after that, and after the end of the pipeline.
 *
 * The PTS is the running time at which the exposure began. The camera's own clock is in a
 * #GstReferenceTimestampMeta with the caps `timestamp/x-ptp` if it follows PTP, else `timestamp/x-camera`.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 lenssweepsrc camera=Fake_1 trigger=free-run rate=5 num-buffers=24 ! focalstackmux ! fakesink
 * ]| A camera that Aravis simulates; it ignores triggers and needs `trigger=free-run`. The one of
 * `arv-fake-gv-camera-0.8 -i lo`, behind real packets, has no lines either. It takes software triggers, but
 * exposes at the ticks of a clock of its own, 25 times a second: up to 40 ms after the trigger. Planes are
 * told by times that must be right within a quarter of a period, so that one has to be 160 ms or longer:
 * `lenssweepsrc camera=Aravis-Fake-GV01 trigger=software planes=6 rate=1`. If it is shorter the stream ends
 * with an error after some sweeps without a frame.
 *
 * With a real camera and a sequencer: `lenssweepsrc lens=fpga:/dev/i2c-1@0x3c run-line=gpiochip0:5
 * sync-line=gpiochip0:6 near=5 far=0`.
 */
#include "lenssweepsrc.h"

#include "calibrated_powers.h"
#include "lenssweepsrc_private.h"
#include "stream_pad.h"

#include <exception>
#include <gst/video/video.h>
#include <memory>

GST_DEBUG_CATEGORY(gst_lens_sweep_src_debug);

G_DEFINE_FINAL_TYPE(GstLensSweepSrc, gst_lens_sweep_src, GST_TYPE_PUSH_SRC)
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(lenssweepsrc, "lenssweepsrc", GST_RANK_NONE, GST_TYPE_LENS_SWEEP_SRC,
                                      GST_DEBUG_CATEGORY_INIT(gst_lens_sweep_src_debug, "lenssweepsrc", 0,
                                                              "camera behind a swept lens"))

static void put_capture(GstLensSweepSrc *self, std::shared_ptr<dff::SweepCapture> capture)
{
    GST_OBJECT_LOCK(self);
    self->state->capture.swap(capture);
    GST_OBJECT_UNLOCK(self);
}

static void put_settings(GstLensSweepSrc *self, const dff::CaptureSettings &settings)
{
    GST_OBJECT_LOCK(self);
    self->state->settings = settings;
    GST_OBJECT_UNLOCK(self);
}

static void log_event(GstLensSweepSrc *self, const std::string &event)
{
    GST_INFO_OBJECT(self, "%s", event.c_str());
}

static void log_verdict(GstLensSweepSrc *self, const dff::CameraFrame &frame,
                        const dff::FrameVerdict &verdict)
{
    if (verdict.label)
        GST_LOG_OBJECT(self, "frame %" G_GUINT64_FORMAT ": sweep %" G_GUINT64_FORMAT " plane %u", frame.id,
                       verdict.label->sweep, verdict.label->plane);
    else
        GST_DEBUG_OBJECT(self, "frame %" G_GUINT64_FORMAT " is dropped: %s", frame.id,
                         dff::name_of(verdict.reason));
}

static dff::CaptureLog capture_log(GstLensSweepSrc *self)
{
    return {
        [self](const auto &event) { log_event(self, event); },
        [self](const auto &frame, const auto &verdict) { log_verdict(self, frame, verdict); },
    };
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

static void warn_of_simulated_camera(GstLensSweepSrc *self, const dff::CaptureSettings &settings)
{
    if (settings.trigger != dff::TriggerKind::FreeRun && self->state->capture->camera().ignores_triggers())
        GST_ELEMENT_WARNING(
            self, RESOURCE, SETTINGS,
            ("Aravis simulates this camera, and it ignores triggers: its planes cannot be told. "
             "Set trigger=free-run."),
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
    state.failed = false;
    try {
        put_settings(self, properties.settings());
        state.calibrated_powers = calibrated_powers(state.settings.calibration, state.settings.plan.planes());
        auto capture = std::make_shared<dff::SweepCapture>(state.settings, capture_log(self));
        GST_INFO_OBJECT(self, "camera %s, lens %s, run-line %s, sync-line %s",
                        capture->camera().title().c_str(), state.settings.lens.c_str(),
                        state.settings.run_line.c_str(), state.settings.sync_line.c_str());
        state.clock_caps = capture->camera().has_ptp()
                               ? gst_caps_from_string("timestamp/x-ptp,version=IEEE1588-2008,domain=0")
                               : gst_caps_new_empty_simple("timestamp/x-camera");
        put_capture(self, std::move(capture));
    } catch (const std::exception &error) {
        gst_lens_sweep_src_post_error(self, error);
        return FALSE;
    }
    warn_of_blind_labels(self, state.settings);
    warn_of_simulated_camera(self, state.settings);
    return TRUE;
}

static gboolean stop(GstBaseSrc *source)
{
    auto *self = GST_LENS_SWEEP_SRC(source);
    self->state->capture->stop();
    const dff::CaptureCounts counts = self->state->capture->counts();
    GST_OBJECT_LOCK(self);
    self->state->counts = counts;
    GST_OBJECT_UNLOCK(self);
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
        gst_lens_sweep_src_post_error(self, error);
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
        gst_lens_sweep_src_post_error(self, error);
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
        GST_INFO_OBJECT(self, "pictures are %" GST_PTR_FORMAT, caps);
        warn_of_odd_size(self, format);
        state.format = format;
        state.running = false;
    } catch (const std::exception &error) {
        gst_lens_sweep_src_post_error(self, error);
        return FALSE;
    }
    return TRUE;
}

static void post_nothing_fits(GstBaseSrc *source, const GstCaps *possible)
{
    gint numerator = 0;
    gint denominator = 1;
    gst_structure_get_fraction(gst_caps_get_structure(possible, 0), "framerate", &numerator, &denominator);
    GST_ELEMENT_ERROR(source, STREAM, FORMAT,
                      ("Nothing downstream takes this camera's pictures. Ask for a size it has, and for a "
                       "frame rate of %d/%d, which is planes times rate; put a videoconvert behind this "
                       "element for other formats.",
                       numerator, denominator),
                      ("possible caps are %" GST_PTR_FORMAT, possible));
}

/* GstBaseSrc does not say what did not fit, and gives up where a capsfilter is set to other caps between its
 * answer to what it takes and the caps that follow from it, if it has not said so yet. Ten times in a row is
 * no coincidence any more. */
static gboolean negotiate(GstBaseSrc *source)
{
    GstPad *pad = GST_BASE_SRC_PAD(source);
    for (int attempt = 0; attempt < 10; attempt++) {
        if (GST_BASE_SRC_CLASS(gst_lens_sweep_src_parent_class)->negotiate(source) && caps_are_taken(pad))
            return TRUE;
        if (GST_PAD_IS_FLUSHING(pad) || GST_LENS_SWEEP_SRC(source)->state->failed)
            return FALSE;
        g_autoptr(GstCaps) possible = gst_pad_query_caps(pad, nullptr);
        g_autoptr(GstCaps) common = gst_pad_get_allowed_caps(pad);
        if (common && gst_caps_is_empty(common) && !gst_caps_is_empty(possible)) {
            post_nothing_fits(source, possible);
            return FALSE;
        }
    }
    return FALSE;
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

/* Once an error of this element is on the bus, what GstBaseSrc adds to it ("failed to post a proper error
 * message", "Internal data stream error") would only hide it. */
static gboolean post_message(GstElement *element, GstMessage *message)
{
    auto *self = GST_LENS_SWEEP_SRC(element);
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR && self->state->failed.exchange(true)) {
        GST_DEBUG_OBJECT(self, "not posted: %" GST_PTR_FORMAT, message);
        gst_message_unref(message);
        return TRUE;
    }
    return GST_ELEMENT_CLASS(gst_lens_sweep_src_parent_class)->post_message(element, message);
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
            "unlabelled; disagreements, dropped-sweeps, wrong-edges, restarts; triggers, where the "
            "sequencer of the lens counts them, and wrong-counts, at which that contradicted the sync line",
            GST_TYPE_STRUCTURE, static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));

    element_class->change_state = change_state;
    element_class->post_message = post_message;
    source_class->start = start;
    source_class->stop = stop;
    source_class->unlock = unlock;
    source_class->unlock_stop = unlock_stop;
    source_class->get_caps = get_caps;
    source_class->fixate = fixate;
    source_class->negotiate = negotiate;
    source_class->set_caps = set_caps;
    source_class->query = query;
    GST_PUSH_SRC_CLASS(klass)->create = gst_lens_sweep_src_create;

    g_autoptr(GstCaps) caps = camera_template_caps();
    gst_element_class_add_pad_template(element_class,
                                       gst_pad_template_new("src", GST_PAD_SRC, GST_PAD_ALWAYS, caps));
    gst_element_class_set_static_metadata(element_class, "Swept camera", "Source/Video/Hardware",
                                          "Planes of a GenICam camera behind a swept lens",
                                          "the gst-plugins-dff authors");
    mark_camera_types();
}
