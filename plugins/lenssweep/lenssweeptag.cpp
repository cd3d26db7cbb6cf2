/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-lenssweeptag
 * @title: lenssweeptag
 * @short_description: says which plane of which sweep a frame is
 *
 * Gives the frames of any source their #GstFocusMeta.
 *
 * With mode=cycle the lens cycles through its planes by itself, the first frame is plane 0, the nearest, and
 * frames are counted. Lost frames are counted too. Where the source numbers its frames (OFFSET_END = OFFSET +
 * 1, as v4l2src does) the numbers say how many are missing; without numbers, a frame with the flag DISCONT is
 * placed by its time and the frame rate. Where neither is known, or after a flush, the next frame begins a
 * new sweep; if that is a guess in the middle of a stream, a warning message is posted.
 *
 * With mode=step the element moves the lens: to a plane, waits until it rests, lets one frame through, and
 * goes on to the next plane. Frames of a live source that were exposed while the lens moved are dropped, by
 * their timestamps, and settle-frames more. `v4l2src ! lenssweeptag lens=v4l2:/dev/video0 mode=step` sweeps a
 * camera whose driver can focus; such a lens has no unit, so planes have no power, and the largest value of
 * its control is the nearest plane.
 *
 * With mode=sync the lens sweeps by itself, or in the hands of the FPGA (lens=fpga:/dev/i2c-1), and sync-line
 * has an edge whenever plane 0 is exposed. A frame is let through only if edges and frames agree on its
 * plane; the others are dropped and counted in stats. See timestamp-delay for cameras that stamp frames late.
 *
 * Pixels are neither copied nor touched.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 videotestsrc num-buffers=60 ! lenssweeptag planes=10 near=4 far=0.5 ! fakesink silent=false
 * -v
 * ]|
 */
#include "lenssweeptag.h"

#include "frame_cycle.h"
#include "lens/open_lens.h"
#include "step_tagger.h"
#include "sync_tagger.h"
#include "tag_settings.h"

#include <cmath>
#include <exception>
#include <gst/dff/dff.h>
#include <gst/video/video.h>

GST_DEBUG_CATEGORY_STATIC(gst_lens_sweep_tag_debug);
#define GST_CAT_DEFAULT gst_lens_sweep_tag_debug

#define CAPS "video/x-raw(ANY); video/x-bayer(ANY)"

static GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(CAPS));
static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(CAPS));

namespace {

enum { PROP_STATS = first_id_after_tag_properties };

/* Sweeps without a label after which mode=sync says what is wrong. */
constexpr guint patience_sweeps = 16;

struct TagCounts {
    guint64 frames = 0;
    guint64 labelled = 0;
    guint64 dropped = 0;
};

} // namespace

struct GstLensSweepTagState {
    /* Guarded by the object lock. */
    TagSettings settings;
    TagCounts counts;
    std::stop_source stop; /* of a wait for the lens; requested while flushing or stopping */

    /* Guarded by the sink pad's stream lock, while started. One of the last three is there, by mode. */
    std::optional<dff::SweepPlan> plan;
    TagSettings used;
    guint64 frames = 0;
    guint unlabelled = 0; /* frames in a row */
    std::optional<FrameCycle> cycle;
    std::unique_ptr<StepTagger> step;
    std::unique_ptr<SyncTagger> sync;
};

struct _GstLensSweepTag {
    GstBaseTransform parent;
    GstLensSweepTagState *state;
};

G_DEFINE_FINAL_TYPE(GstLensSweepTag, gst_lens_sweep_tag, GST_TYPE_BASE_TRANSFORM)
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(lenssweeptag, "lenssweeptag", GST_RANK_NONE, GST_TYPE_LENS_SWEEP_TAG,
                                      GST_DEBUG_CATEGORY_INIT(gst_lens_sweep_tag_debug, "lenssweeptag", 0,
                                                              "labels of swept planes"))

/* Opens what the mode needs. Throws what is wrong, for the user. */
static void open_mode(GstLensSweepTagState &state)
{
    const TagSettings &settings = state.used;
    state.plan = settings.sweep.plan();
    auto lens = dff::open_lens(dff::LensUri::parse(settings.lens), {settings.lens_profile});
    auto *stepped = dynamic_cast<dff::SteppedLens *>(lens.get());
    auto *sequenced = dynamic_cast<dff::SequencedLens *>(lens.get());
    if (settings.mode == GST_LENS_SWEEP_TAG_MODE_CYCLE) {
        if (stepped || sequenced)
            throw std::invalid_argument("mode=cycle moves no lens; use mode=step with lens=" + settings.lens +
                                        ", or mode=sync with lens=fpga:");
        state.cycle.emplace(state.plan->planes(), std::nullopt);
    } else if (settings.mode == GST_LENS_SWEEP_TAG_MODE_STEP) {
        if (!stepped)
            throw std::invalid_argument(
                "mode=step needs a lens that can be moved, as lens=v4l2:/dev/video0 or "
                "lens=max14574:/dev/i2c-1");
        lens->prepare({*state.plan});
        lens->start();
        lens.release();
        state.step = std::make_unique<StepTagger>(std::unique_ptr<dff::SteppedLens>(stepped),
                                                  state.plan->planes(), settings.settle_frames);
    } else {
        if (stepped || settings.sync_line.empty())
            throw std::invalid_argument("mode=sync needs sync-line, as gpiochip0:5, and lens=fpga: or none");
        lens.release();
        state.sync =
            std::make_unique<SyncTagger>(dff::open_edge_line(settings.sync_line),
                                         std::unique_ptr<dff::SequencedLens>(sequenced), *state.plan);
    }
}

static void close_mode(GstLensSweepTagState &state)
{
    state.cycle.reset();
    state.step.reset();
    state.sync.reset();
}

static gboolean start(GstBaseTransform *transform)
{
    auto *self = GST_LENS_SWEEP_TAG(transform);
    GstLensSweepTagState &state = *self->state;
    GST_OBJECT_LOCK(self);
    state.used = state.settings;
    state.counts = {};
    GST_OBJECT_UNLOCK(self);
    state.frames = 0;
    state.unlabelled = 0;
    try {
        open_mode(state);
    } catch (const std::invalid_argument &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("The properties cannot be used: %s.", error.what()),
                          (nullptr));
        close_mode(state);
        return FALSE;
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, OPEN_READ_WRITE, ("The sweep cannot begin: %s.", error.what()),
                          (nullptr));
        close_mode(state);
        return FALSE;
    }
    return TRUE;
}

static gboolean stop(GstBaseTransform *transform)
{
    close_mode(*GST_LENS_SWEEP_TAG(transform)->state);
    return TRUE;
}

static std::optional<uint64_t> frame_period(const GstCaps *caps)
{
    gint numerator = 0;
    gint denominator = 1;
    const GstStructure *structure = gst_caps_get_structure(caps, 0);
    if (!gst_structure_get_fraction(structure, "framerate", &numerator, &denominator) || numerator <= 0)
        return std::nullopt;
    return gst_util_uint64_scale_int(GST_SECOND, denominator, numerator);
}

static gboolean set_caps(GstBaseTransform *transform, GstCaps *caps, GstCaps *)
{
    auto *self = GST_LENS_SWEEP_TAG(transform);
    GstLensSweepTagState &state = *self->state;
    const auto period = frame_period(caps);
    try {
        if (state.cycle)
            state.cycle->set_period(period);
        else if (state.step)
            state.step->set_period(period);
        else
            state.sync->begin(std::chrono::microseconds{period.value_or(0) / 1000});
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS,
                          ("The lens cannot sweep at the frame rate of this stream: %s.", error.what()),
                          (nullptr));
        return FALSE;
    }
    return TRUE;
}

/* Ends waits for the lens, or lets them begin again. */
static void set_interrupted(GstLensSweepTag *self, bool interrupted)
{
    GST_OBJECT_LOCK(self);
    if (interrupted)
        self->state->stop.request_stop();
    else
        self->state->stop = {};
    GST_OBJECT_UNLOCK(self);
}

static gboolean sink_event(GstBaseTransform *transform, GstEvent *event)
{
    auto *self = GST_LENS_SWEEP_TAG(transform);
    if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_START)
        set_interrupted(self, true);
    if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP) {
        set_interrupted(self, false);
        if (self->state->cycle)
            self->state->cycle->restart();
        if (self->state->step)
            self->state->step->restart();
    }
    return GST_BASE_TRANSFORM_CLASS(gst_lens_sweep_tag_parent_class)->sink_event(transform, event);
}

static GstStateChangeReturn change_state(GstElement *element, GstStateChange transition)
{
    if (transition == GST_STATE_CHANGE_READY_TO_PAUSED || transition == GST_STATE_CHANGE_PAUSED_TO_READY)
        set_interrupted(GST_LENS_SWEEP_TAG(element), transition == GST_STATE_CHANGE_PAUSED_TO_READY);
    return GST_ELEMENT_CLASS(gst_lens_sweep_tag_parent_class)->change_state(element, transition);
}

/* A buffer of others is copied without its pixels, since only a meta is added. */
static GstFlowReturn prepare_output_buffer(GstBaseTransform *, GstBuffer *input, GstBuffer **output)
{
    *output = gst_buffer_is_writable(input) ? input : gst_buffer_copy(input);
    return GST_FLOW_OK;
}

static FrameTrace trace_of(const GstBuffer *buffer)
{
    FrameTrace trace;
    const bool numbered = GST_BUFFER_OFFSET_IS_VALID(buffer) && GST_BUFFER_OFFSET_END_IS_VALID(buffer) &&
                          GST_BUFFER_OFFSET_END(buffer) == GST_BUFFER_OFFSET(buffer) + 1;
    if (numbered)
        trace.number = GST_BUFFER_OFFSET(buffer);
    if (GST_BUFFER_PTS_IS_VALID(buffer))
        trace.time_ns = GST_BUFFER_PTS(buffer);
    trace.discontinuous = GST_BUFFER_IS_DISCONT(buffer);
    return trace;
}

/* The time of a frame on CLOCK_MONOTONIC, in which the kernel stamps edges; unknown without a running clock.
 */
static std::optional<uint64_t> monotonic_time_of(GstBaseTransform *transform, const GstBuffer *buffer)
{
    g_autoptr(GstClock) clock = gst_element_get_clock(GST_ELEMENT(transform));
    const GstClockTime running =
        gst_segment_to_running_time(&transform->segment, GST_FORMAT_TIME, GST_BUFFER_PTS(buffer));
    if (!clock || !GST_CLOCK_TIME_IS_VALID(running))
        return std::nullopt;
    const GstClockTime stamped = gst_element_get_base_time(GST_ELEMENT(transform)) + running;
    const GstClockTimeDiff ago = GST_CLOCK_DIFF(stamped, gst_clock_get_time(clock));
    return static_cast<uint64_t>(g_get_monotonic_time() * 1000 - ago);
}

static PlaneLabel cycle_label(GstLensSweepTag *self, const FrameTrace &trace)
{
    FrameCycle &cycle = *self->state->cycle;
    const PlaneLabel label = cycle.label(trace);
    if (cycle.lost_place())
        GST_ELEMENT_WARNING(
            self, STREAM, FAILED,
            ("Frames are missing and nothing says how many; the planes may be labelled wrongly from "
             "here on. Use a source that numbers its frames or gives them times."),
            ("sweep %" G_GUINT64_FORMAT " begins", label.sweep));
    return label;
}

/* Says, once, what keeps frames and edges from fitting together. */
static void warn_of_sync(GstLensSweepTag *self)
{
    const SyncTagger &sync = *self->state->sync;
    if (sync.edges() == 0)
        GST_ELEMENT_WARNING(
            self, RESOURCE, READ,
            ("No edges come on the sync line %s, so frames cannot be labelled: see whether the "
             "lens sweeps, and the line is the right one.",
             self->state->used.sync_line.c_str()),
            (nullptr));
    else if (sync.misfit_ns())
        GST_ELEMENT_WARNING(
            self, STREAM, FAILED,
            ("Frames and the edges of the sync line do not fit together: frames lie %.3f ms off. Set "
             "timestamp-delay to the time from exposure to timestamp, and see whether there are %u "
             "planes.",
             static_cast<double>(*sync.misfit_ns()) / 1e6, self->state->plan->planes()),
            (nullptr));
    else
        GST_ELEMENT_WARNING(
            self, STREAM, FAILED,
            ("Frames and the edges of the sync line do not fit together: see whether there are %u "
             "planes, and the camera sends each of them.",
             self->state->plan->planes()),
            (nullptr));
}

static std::optional<PlaneLabel> find_label(GstLensSweepTag *self, GstBuffer *buffer, const FrameTrace &trace)
{
    GstLensSweepTagState &state = *self->state;
    if (state.cycle)
        return cycle_label(self, trace);
    auto time = monotonic_time_of(GST_BASE_TRANSFORM(self), buffer);
    if (state.step) {
        GST_OBJECT_LOCK(self);
        const std::stop_token stop = state.stop.get_token();
        GST_OBJECT_UNLOCK(self);
        return state.step->label(time, stop);
    }
    if (time)
        *time -= state.used.timestamp_delay_ns;
    const auto label = state.sync->label(time);
    GST_LOG_OBJECT(self,
                   "exposed at %" GST_TIME_FORMAT ", after %" G_GUINT64_FORMAT
                   " edges: plane %d, misfit %" G_GINT64_FORMAT " ns",
                   GST_TIME_ARGS(time.value_or(GST_CLOCK_TIME_NONE)), state.sync->edges(),
                   label ? static_cast<int>(label->plane) : -1, state.sync->misfit_ns().value_or(0));
    state.unlabelled = label ? 0 : state.unlabelled + 1;
    if (state.unlabelled == patience_sweeps * state.plan->planes())
        warn_of_sync(self);
    return label;
}

static void add_focus_meta(GstLensSweepTagState &state, GstBuffer *buffer, const PlaneLabel &label,
                           guint64 frame_id)
{
    GstFocusInfo focus;
    gst_focus_info_init(&focus);
    focus.sweep = label.sweep;
    focus.plane = label.plane;
    focus.planes = state.plan->planes();
    focus.power = state.step && !state.step->calibrated() ? NAN : state.plan->power(label.plane);
    if (state.step)
        focus.code = state.step->code(label.plane);
    else if (state.sync)
        focus.code = state.sync->code(label.plane);
    focus.frame_id = frame_id;
    if (GstFocusMeta *old = gst_buffer_get_focus_meta(buffer))
        gst_buffer_remove_meta(buffer, &old->meta);
    gst_buffer_add_focus_meta(buffer, &focus);
}

static GstFlowReturn transform_ip(GstBaseTransform *transform, GstBuffer *buffer)
{
    auto *self = GST_LENS_SWEEP_TAG(transform);
    GstLensSweepTagState &state = *self->state;
    const FrameTrace trace = trace_of(buffer);
    std::optional<PlaneLabel> label;
    try {
        label = find_label(self, buffer, trace);
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, FAILED, ("The sweep has stopped: %s.", error.what()), (nullptr));
        return GST_FLOW_ERROR;
    }
    const guint64 frame_id = trace.number.value_or(state.frames);
    state.frames++;
    GST_OBJECT_LOCK(self);
    state.counts.frames++;
    (label ? state.counts.labelled : state.counts.dropped)++;
    GST_OBJECT_UNLOCK(self);
    if (!label)
        return GST_BASE_TRANSFORM_FLOW_DROPPED;
    add_focus_meta(state, buffer, *label, frame_id);
    return GST_FLOW_OK;
}

/* Called with the object lock held. */
static GstStructure *new_stats(const TagCounts &counts)
{
    return gst_structure_new("application/x-lens-sweep-tag-stats", "frames", G_TYPE_UINT64, counts.frames,
                             "labelled", G_TYPE_UINT64, counts.labelled, "dropped", G_TYPE_UINT64,
                             counts.dropped, nullptr);
}

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *pspec)
{
    auto *self = GST_LENS_SWEEP_TAG(object);
    GST_OBJECT_LOCK(self);
    const bool known = set_tag_property(self->state->settings, id, value);
    GST_OBJECT_UNLOCK(self);
    if (!known)
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    auto *self = GST_LENS_SWEEP_TAG(object);
    GST_OBJECT_LOCK(self);
    bool known = true;
    if (id == PROP_STATS)
        g_value_take_boxed(value, new_stats(self->state->counts));
    else
        known = get_tag_property(self->state->settings, id, value);
    GST_OBJECT_UNLOCK(self);
    if (!known)
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void finalize(GObject *object)
{
    delete GST_LENS_SWEEP_TAG(object)->state;
    G_OBJECT_CLASS(gst_lens_sweep_tag_parent_class)->finalize(object);
}

static void gst_lens_sweep_tag_init(GstLensSweepTag *self)
{
    self->state = new GstLensSweepTagState;
}

static void gst_lens_sweep_tag_class_init(GstLensSweepTagClass *klass)
{
    auto *object_class = G_OBJECT_CLASS(klass);
    auto *element_class = GST_ELEMENT_CLASS(klass);
    auto *transform_class = GST_BASE_TRANSFORM_CLASS(klass);

    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->finalize = finalize;
    install_tag_properties(object_class);
    g_object_class_install_property(
        object_class, PROP_STATS,
        g_param_spec_boxed(
            "stats", "Statistics",
            "Counts since the start: frames that came in, those labelled, and those dropped since the "
            "lens moved (step) or their plane was not sure (sync)",
            GST_TYPE_STRUCTURE, static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));

    element_class->change_state = change_state;
    transform_class->start = start;
    transform_class->stop = stop;
    transform_class->set_caps = set_caps;
    transform_class->sink_event = sink_event;
    transform_class->prepare_output_buffer = prepare_output_buffer;
    transform_class->transform_ip = transform_ip;
    gst_element_class_add_static_pad_template(element_class, &sink_template);
    gst_element_class_add_static_pad_template(element_class, &src_template);
    gst_element_class_set_static_metadata(element_class, "Focus sweep labeller", "Filter/Video",
                                          "Says which plane of which focus sweep each frame is",
                                          "the gst-plugins-dff authors");
    gst_type_mark_as_plugin_api(gst_lens_sweep_tag_mode_get_type(), static_cast<GstPluginAPIFlags>(0));
}
