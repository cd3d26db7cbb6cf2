/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-aifcompose
 * @title: aifcompose
 * @short_description: all-in-focus pictures from focal stacks and depth
 *
 * Takes each pixel from the planes around its depth. Stack and depth are matched by the stack's number;
 * without metas the first goes with the first, and so on. A stack without usable depth gives a picture all
 * the same, the mean of its planes. Put a queue on every branch.
 *
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=60 ! focalstackmux ! tee name=s \
 *     s. ! queue ! dffdepth ! queue ! c.depth  s. ! queue ! c.stack \
 *     aifcompose name=c ! videoconvert ! fakesink
 * ]|
 */
#include "aifcompose.h"

#include "aif_picture.h"
#include "gstcl/engine_message.h"

#include <gst/dff/dff.h>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

GST_DEBUG_CATEGORY_STATIC(aif_compose_debug);
#define GST_CAT_DEFAULT aif_compose_debug

#define GST_TYPE_AIF_BLEND (gst_aif_blend_get_type())

static GType gst_aif_blend_get_type()
{
    static const GEnumValue values[] = {
        {static_cast<int>(dff::AifComposer::Blend::Linear), "Between the two planes around the depth",
         "linear"},
        {static_cast<int>(dff::AifComposer::Blend::Sharp),
         "The sharper ones of the planes around the depth: for planes that lie far apart", "sharp"},
        {static_cast<int>(dff::AifComposer::Blend::Soft),
         "As linear; in noise a Gaussian over the neighbouring planes, which averages it", "soft"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstAifBlend", values);
    return type;
}

namespace {

enum Property : guint { PropertyBlend = 1, PropertyDevice, PropertyStats };

struct State {
    /* Guards the properties and statistics; nothing else is locked under it but the element's own lock. */
    std::mutex mutex;
    dff::AifComposer::Blend blend = dff::AifComposer::Blend::Soft;
    std::string device_wish;
    guint64 pictures = 0;
    guint64 without_depth = 0;
    GstClockTime compute_time = 0;
    GstClockTime latency = 0;

    /* The streaming thread's own. */
    dff::AifPicture picture;
    bool has_stack_caps = false;
};

} // namespace

struct _GstAifCompose {
    GstAggregator parent;
    GstAggregatorPad *stack_pad;
    GstAggregatorPad *depth_pad;
    State *state;
};

G_DEFINE_FINAL_TYPE(GstAifCompose, gst_aif_compose, GST_TYPE_AGGREGATOR)
GST_ELEMENT_REGISTER_DEFINE(aifcompose, "aifcompose", GST_RANK_NONE, GST_TYPE_AIF_COMPOSE)

static GstStaticPadTemplate stack_template = GST_STATIC_PAD_TEMPLATE(
    "stack", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_FOCAL_STACK_CAPS_MAKE));
static GstStaticPadTemplate depth_template = GST_STATIC_PAD_TEMPLATE(
    "depth", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("GRAY16_LE")));
static GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE(GST_FOCAL_STACK_FORMATS)));

/* The depth map that goes with `stack`, or nullptr if it has none; empty if it has not come yet. Maps of
 * stacks that never came are dropped. */
static std::optional<GstBuffer *> matching_depth(GstAifCompose *self, GstBuffer *stack)
{
    const GstFocalStackMeta *stack_meta = gst_buffer_get_focal_stack_meta(stack);

    while (GstBuffer *depth = gst_aggregator_pad_peek_buffer(self->depth_pad)) {
        const GstDepthMeta *depth_meta = gst_buffer_get_depth_meta(depth);
        const bool is_gap = gst_buffer_get_size(depth) == 0;
        const bool comparable = stack_meta && depth_meta;
        if (!is_gap && (!comparable || depth_meta->sequence == stack_meta->sequence)) {
            gst_aggregator_pad_drop_buffer(self->depth_pad);
            return depth;
        }
        const bool later = comparable && depth_meta->sequence > stack_meta->sequence;
        gst_buffer_unref(depth);
        if (later)
            return nullptr;
        GST_DEBUG_OBJECT(self, "dropping a depth map without its stack, or a gap");
        gst_aggregator_pad_drop_buffer(self->depth_pad);
        if (is_gap && !stack_meta)
            return nullptr; /* the k-th with the k-th */
    }
    if (gst_aggregator_pad_is_eos(self->depth_pad))
        return nullptr;
    return std::nullopt;
}

static void account(GstAifCompose *self, GstClockTime compute_time, bool with_depth)
{
    State &state = *self->state;
    GstClockTime latency = 0;
    {
        const std::lock_guard lock(state.mutex);
        state.pictures++;
        state.without_depth += !with_depth;
        state.compute_time = compute_time;
        if (compute_time <= state.latency + state.latency / 4 + GST_MSECOND)
            return;
        latency = state.latency = compute_time;
    }
    gst_aggregator_set_latency(GST_AGGREGATOR(self), latency, latency);
}

static dff::AifComposer::Blend blend_of(State &state)
{
    const std::lock_guard lock(state.mutex);
    return state.blend;
}

static GstFlowReturn compose_and_push(GstAifCompose *self, GstBuffer *stack, GstBuffer *depth)
{
    State &state = *self->state;
    try {
        const GstClockTime start = gst_util_get_timestamp();
        GstBuffer *picture = state.picture.compose(stack, depth, blend_of(state));
        account(self, gst_util_get_timestamp() - start, depth != nullptr);
        gst_aggregator_selected_samples(GST_AGGREGATOR(self), GST_BUFFER_PTS(picture),
                                        GST_BUFFER_DTS(picture), GST_BUFFER_DURATION(picture), nullptr);
        return gst_aggregator_finish_buffer(GST_AGGREGATOR(self), picture);
    } catch (const dff::EngineError &error) {
        dff::post_engine_error(GST_ELEMENT(self), error);
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("%s", error.what()), (nullptr));
    }
    return GST_FLOW_ERROR;
}

static GstFlowReturn gst_aif_compose_aggregate(GstAggregator *aggregator, gboolean)
{
    GstAifCompose *self = GST_AIF_COMPOSE(aggregator);
    g_autoptr(GstBuffer) stack = gst_aggregator_pad_peek_buffer(self->stack_pad);

    if (!stack)
        return gst_aggregator_pad_is_eos(self->stack_pad) ? GST_FLOW_EOS : GST_AGGREGATOR_FLOW_NEED_DATA;
    if (!self->state->has_stack_caps)
        return GST_FLOW_NOT_NEGOTIATED;
    if (gst_buffer_get_size(stack) == 0) { /* a gap */
        gst_aggregator_pad_drop_buffer(self->stack_pad);
        return GST_FLOW_OK;
    }
    const std::optional<GstBuffer *> match = matching_depth(self, stack);
    if (!match)
        return GST_AGGREGATOR_FLOW_NEED_DATA;
    g_autoptr(GstBuffer) depth = *match;
    gst_aggregator_pad_drop_buffer(self->stack_pad);
    return compose_and_push(self, stack, depth);
}

static gboolean set_stack_caps(GstAifCompose *self, const GstCaps *caps)
{
    State &state = *self->state;
    GstFocalStackInfo info;
    if (!gst_focal_stack_info_from_caps(&info, caps))
        return FALSE;
    state.picture.set_stack(info);
    state.has_stack_caps = true;
    gst_pad_mark_reconfigure(GST_AGGREGATOR_SRC_PAD(self));
    return TRUE;
}

static gboolean set_depth_caps(GstAifCompose *self, const GstCaps *caps)
{
    GstVideoInfo info;
    if (!gst_video_info_from_caps(&info, caps))
        return FALSE;
    self->state->picture.set_depth(info);
    return TRUE;
}

static GstFlowReturn gst_aif_compose_update_src_caps(GstAggregator *aggregator, GstCaps *, GstCaps **caps)
{
    const State &state = *GST_AIF_COMPOSE(aggregator)->state;
    if (!state.has_stack_caps)
        return GST_AGGREGATOR_FLOW_NEED_DATA;
    *caps = gst_video_info_to_caps(&state.picture.stack().frame);
    return GST_FLOW_OK;
}

static gboolean gst_aif_compose_sink_event(GstAggregator *aggregator, GstAggregatorPad *pad, GstEvent *event)
{
    GstAifCompose *self = GST_AIF_COMPOSE(aggregator);

    if (GST_EVENT_TYPE(event) == GST_EVENT_CAPS) {
        GstCaps *caps = nullptr;
        gst_event_parse_caps(event, &caps);
        const gboolean accepted =
            pad == self->stack_pad ? set_stack_caps(self, caps) : set_depth_caps(self, caps);
        gst_event_unref(event);
        return accepted;
    }
    if (GST_EVENT_TYPE(event) == GST_EVENT_SEGMENT && pad == self->stack_pad) {
        const GstSegment *segment = nullptr;
        gst_event_parse_segment(event, &segment);
        if (segment->format == GST_FORMAT_TIME)
            gst_aggregator_update_segment(aggregator, segment);
    }
    return GST_AGGREGATOR_CLASS(gst_aif_compose_parent_class)->sink_event(aggregator, pad, event);
}

static gboolean gst_aif_compose_propose_allocation(GstAggregator *, GstAggregatorPad *, GstQuery *,
                                                   GstQuery *query)
{
    gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
    return TRUE;
}

static gboolean gst_aif_compose_start(GstAggregator *aggregator)
{
    GstAifCompose *self = GST_AIF_COMPOSE(aggregator);
    State &state = *self->state;
    for (GstAggregatorPad *pad : {self->stack_pad, self->depth_pad})
        if (!gst_pad_is_linked(GST_PAD(pad))) {
            GST_ELEMENT_ERROR(
                self, CORE, PAD,
                ("The pad \"%s\" is not linked: aifcompose needs a stack and its depth", GST_PAD_NAME(pad)),
                (nullptr));
            return FALSE;
        }
    try {
        const std::lock_guard lock(state.mutex);
        state.picture.start(dff::Device::open(state.device_wish));
    } catch (const dff::EngineError &error) {
        dff::post_engine_error(GST_ELEMENT(self), error);
        return FALSE;
    }
    return TRUE;
}

static gboolean gst_aif_compose_stop(GstAggregator *aggregator)
{
    State &state = *GST_AIF_COMPOSE(aggregator)->state;
    state.picture.stop();
    state.has_stack_caps = false;
    const std::lock_guard lock(state.mutex);
    state.pictures = state.without_depth = 0;
    state.latency = 0;
    return TRUE;
}

static void gst_aif_compose_set_property(GObject *object, guint id, const GValue *value, GParamSpec *pspec)
{
    State &state = *GST_AIF_COMPOSE(object)->state;
    const std::lock_guard lock(state.mutex);
    if (id == PropertyBlend)
        state.blend = static_cast<dff::AifComposer::Blend>(g_value_get_enum(value));
    else if (id == PropertyDevice)
        state.device_wish = g_value_get_string(value) ? g_value_get_string(value) : "";
    else
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void gst_aif_compose_get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    State &state = *GST_AIF_COMPOSE(object)->state;
    const std::lock_guard lock(state.mutex);
    if (id == PropertyBlend)
        g_value_set_enum(value, static_cast<int>(state.blend));
    else if (id == PropertyDevice)
        g_value_set_string(value, state.device_wish.c_str());
    else if (id == PropertyStats)
        g_value_take_boxed(value, gst_structure_new("aifcompose-stats", "pictures", G_TYPE_UINT64,
                                                    state.pictures, "without-depth", G_TYPE_UINT64,
                                                    state.without_depth, "compute-ms", G_TYPE_DOUBLE,
                                                    static_cast<gdouble>(state.compute_time) / 1e6, nullptr));
    else
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void gst_aif_compose_finalize(GObject *object)
{
    delete GST_AIF_COMPOSE(object)->state;
    G_OBJECT_CLASS(gst_aif_compose_parent_class)->finalize(object);
}

/* Always pads, built here so that they keep their names. */
static GstAggregatorPad *add_sink(GstAifCompose *self, GstStaticPadTemplate *static_template)
{
    g_autoptr(GstPadTemplate) pad_template = gst_static_pad_template_get(static_template);
    GstPad *pad = GST_PAD(g_object_new(GST_TYPE_AGGREGATOR_PAD, "name", static_template->name_template,
                                       "direction", GST_PAD_SINK, "template", pad_template, nullptr));
    gst_element_add_pad(GST_ELEMENT(self), pad);
    return GST_AGGREGATOR_PAD(pad);
}

static void gst_aif_compose_init(GstAifCompose *self)
{
    self->state = new State;
    self->stack_pad = add_sink(self, &stack_template);
    self->depth_pad = add_sink(self, &depth_template);
}

static void gst_aif_compose_class_init(GstAifComposeClass *klass)
{
    GObjectClass *object_class = G_OBJECT_CLASS(klass);
    GstElementClass *element_class = GST_ELEMENT_CLASS(klass);
    GstAggregatorClass *aggregator_class = GST_AGGREGATOR_CLASS(klass);

    GST_DEBUG_CATEGORY_INIT(aif_compose_debug, "aifcompose", 0, "all-in-focus pictures");
    object_class->set_property = gst_aif_compose_set_property;
    object_class->get_property = gst_aif_compose_get_property;
    object_class->finalize = gst_aif_compose_finalize;
    aggregator_class->aggregate = gst_aif_compose_aggregate;
    aggregator_class->update_src_caps = gst_aif_compose_update_src_caps;
    aggregator_class->sink_event = gst_aif_compose_sink_event;
    aggregator_class->propose_allocation = gst_aif_compose_propose_allocation;
    aggregator_class->start = gst_aif_compose_start;
    aggregator_class->stop = gst_aif_compose_stop;

    const auto flags = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS);
    g_object_class_install_property(
        object_class, PropertyBlend,
        g_param_spec_enum("blend", "Blend", "How the planes around the depth are mixed", GST_TYPE_AIF_BLEND,
                          static_cast<int>(dff::AifComposer::Blend::Soft),
                          static_cast<GParamFlags>(flags | GST_PARAM_MUTABLE_PLAYING)));
    g_object_class_install_property(
        object_class, PropertyDevice,
        g_param_spec_string(
            "device", "Device",
            "Part of the name of the OpenCL device to compute on, as clinfo -l lists it; empty: the "
            "first GPU, else the CPU",
            "", static_cast<GParamFlags>(flags | GST_PARAM_MUTABLE_READY)));
    g_object_class_install_property(
        object_class, PropertyStats,
        g_param_spec_boxed(
            "stats", "Stats", "Pictures so far, those without any depth, and milliseconds the last one took",
            GST_TYPE_STRUCTURE, static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));

    for (GstStaticPadTemplate *pad_template : {&stack_template, &depth_template})
        gst_element_class_add_static_pad_template_with_gtype(element_class, pad_template,
                                                             GST_TYPE_AGGREGATOR_PAD);
    gst_element_class_add_static_pad_template_with_gtype(element_class, &src_template,
                                                         GST_TYPE_AGGREGATOR_PAD);
    gst_element_class_set_static_metadata(
        element_class, "All-in-focus composer", "Filter/Editor/Video/Compositor",
        "Composes an all-in-focus picture from each focal stack and its depth",
        "the gst-plugins-dff authors");
    gst_type_mark_as_plugin_api(GST_TYPE_AIF_BLEND, static_cast<GstPluginAPIFlags>(0));
}
