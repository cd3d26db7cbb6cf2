/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-lenssweeptag
 * @title: lenssweeptag
 * @short_description: says which plane of which sweep a frame is
 *
 * Gives the frames of any source their #GstFocusMeta. With mode=cycle the lens cycles through its planes by
 * itself, the first frame is plane 0, the nearest, and frames are counted.
 *
 * Lost frames are counted too. Where the source numbers its frames (OFFSET_END = OFFSET + 1, as v4l2src does)
 * the numbers say how many are missing; without numbers, a frame with the flag DISCONT is placed by its time
 * and the frame rate. Where neither is known, or after a flush, the next frame begins a new sweep; if that is
 * a guess in the middle of a stream, a warning message is posted.
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
#include "sweep_properties.h"

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

enum GstLensSweepTagMode { GST_LENS_SWEEP_TAG_MODE_CYCLE };

#define GST_TYPE_LENS_SWEEP_TAG_MODE (gst_lens_sweep_tag_mode_get_type())

static GType gst_lens_sweep_tag_mode_get_type()
{
    static const GEnumValue values[] = {
        {GST_LENS_SWEEP_TAG_MODE_CYCLE, "The lens cycles by itself; frames are counted", "cycle"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstLensSweepTagMode", values);
    return type;
}

namespace {

enum { PROP_MODE = FIRST_OWN_PROPERTY };

} // namespace

struct GstLensSweepTagState {
    /* Guarded by the object lock. */
    SweepProperties sweep;
    GstLensSweepTagMode mode = GST_LENS_SWEEP_TAG_MODE_CYCLE;

    /* Guarded by the sink pad's stream lock, while started. */
    std::optional<dff::SweepPlan> plan;
    std::optional<FrameCycle> cycle;
    guint64 frames = 0;
};

struct _GstLensSweepTag {
    GstBaseTransform parent;
    GstLensSweepTagState *state;
};

G_DEFINE_FINAL_TYPE(GstLensSweepTag, gst_lens_sweep_tag, GST_TYPE_BASE_TRANSFORM)
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(lenssweeptag, "lenssweeptag", GST_RANK_NONE, GST_TYPE_LENS_SWEEP_TAG,
                                      GST_DEBUG_CATEGORY_INIT(gst_lens_sweep_tag_debug, "lenssweeptag", 0,
                                                              "labels of swept planes"))

static gboolean start(GstBaseTransform *transform)
{
    auto *self = GST_LENS_SWEEP_TAG(transform);
    GstLensSweepTagState &state = *self->state;
    GST_OBJECT_LOCK(self);
    const SweepProperties sweep = state.sweep;
    GST_OBJECT_UNLOCK(self);
    try {
        state.plan = sweep.plan();
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("The properties cannot be used: %s.", error.what()),
                          (nullptr));
        return FALSE;
    }
    state.cycle.emplace(state.plan->planes(), std::nullopt);
    state.frames = 0;
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
    GST_LENS_SWEEP_TAG(transform)->state->cycle->set_period(frame_period(caps));
    return TRUE;
}

static gboolean sink_event(GstBaseTransform *transform, GstEvent *event)
{
    if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP)
        GST_LENS_SWEEP_TAG(transform)->state->cycle->restart();
    return GST_BASE_TRANSFORM_CLASS(gst_lens_sweep_tag_parent_class)->sink_event(transform, event);
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

static GstFlowReturn transform_ip(GstBaseTransform *transform, GstBuffer *buffer)
{
    auto *self = GST_LENS_SWEEP_TAG(transform);
    GstLensSweepTagState &state = *self->state;
    const FrameTrace trace = trace_of(buffer);
    const PlaneLabel label = state.cycle->label(trace);
    if (state.cycle->lost_place())
        GST_ELEMENT_WARNING(
            self, STREAM, FAILED,
            ("Frames are missing and nothing says how many; the planes may be labelled wrongly from "
             "here on. Use a source that numbers its frames or gives them times."),
            ("sweep %" G_GUINT64_FORMAT " begins", label.sweep));

    GstFocusInfo focus;
    gst_focus_info_init(&focus);
    focus.sweep = label.sweep;
    focus.plane = label.plane;
    focus.planes = state.plan->planes();
    focus.power = state.plan->power(label.plane);
    focus.frame_id = trace.number.value_or(state.frames);
    state.frames++;
    if (GstFocusMeta *old = gst_buffer_get_focus_meta(buffer))
        gst_buffer_remove_meta(buffer, &old->meta);
    gst_buffer_add_focus_meta(buffer, &focus);
    return GST_FLOW_OK;
}

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *pspec)
{
    auto *self = GST_LENS_SWEEP_TAG(object);
    GST_OBJECT_LOCK(self);
    if (id == PROP_MODE)
        self->state->mode = static_cast<GstLensSweepTagMode>(g_value_get_enum(value));
    else if (!set_sweep_property(self->state->sweep, id, value))
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
    GST_OBJECT_UNLOCK(self);
}

static void get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    auto *self = GST_LENS_SWEEP_TAG(object);
    GST_OBJECT_LOCK(self);
    if (id == PROP_MODE)
        g_value_set_enum(value, self->state->mode);
    else if (!get_sweep_property(self->state->sweep, id, value))
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
    GST_OBJECT_UNLOCK(self);
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
    install_sweep_properties(object_class);
    g_object_class_install_property(
        object_class, PROP_MODE,
        g_param_spec_enum(
            "mode", "Mode", "How the plane of a frame is found", GST_TYPE_LENS_SWEEP_TAG_MODE,
            GST_LENS_SWEEP_TAG_MODE_CYCLE,
            static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY)));

    transform_class->start = start;
    transform_class->set_caps = set_caps;
    transform_class->sink_event = sink_event;
    transform_class->prepare_output_buffer = prepare_output_buffer;
    transform_class->transform_ip = transform_ip;
    gst_element_class_add_static_pad_template(element_class, &sink_template);
    gst_element_class_add_static_pad_template(element_class, &src_template);
    gst_element_class_set_static_metadata(element_class, "Focus sweep labeller", "Filter/Video",
                                          "Says which plane of which focus sweep each frame is",
                                          "the gst-plugins-dff authors");
    gst_type_mark_as_plugin_api(GST_TYPE_LENS_SWEEP_TAG_MODE, static_cast<GstPluginAPIFlags>(0));
}
