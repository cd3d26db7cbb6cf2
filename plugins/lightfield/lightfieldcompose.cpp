/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-lightfieldcompose
 * @title: lightfieldcompose
 * @short_description: colour and depth to what a light-field display shows
 *
 * Makes the views of a row of off-axis cameras out of one picture and its depth: as a quilt, side by side, or
 * straight to the panel pixels under slanted cylindrical lenses or an array of round ones; or colour beside
 * depth. Near surfaces hide far ones, and what a view sees behind an edge is filled from the background.
 *
 * Colour and depth are matched by their running time; without timestamps the first goes with the first, and
 * so on. A picture without depth comes out flat. Put a queue on every branch, and videoconvert before the
 * colour pad.
 *
 * A quilt for a Looking Glass Portrait, at half its usual size; file-suffix is what players want at the end
 * of its name:
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=6 ! focalstackmux ! tee name=s \
 *     s. ! queue ! dffdepth ! tee name=d  d. ! queue ! a.depth  s. ! queue ! a.stack \
 *     aifcompose name=a ! queue ! videoconvert ! l.color  d. ! queue ! l.depth \
 *     lightfieldcompose name=l preset=looking-glass-portrait ! video/x-raw,width=1680,height=1680 ! \
 *     videoconvert ! pngenc ! filesink location=shapes_qs8x6a0.75.png
 * ]|
 * Stereo, with what lies at three dioptres in the plane of the screen:
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=6 ! focalstackmux ! tee name=s \
 *     s. ! queue ! dffdepth ! tee name=d  d. ! queue ! a.depth  s. ! queue ! a.stack \
 *     aifcompose name=a ! queue ! videoconvert ! l.color  d. ! queue ! l.depth \
 *     lightfieldcompose name=l layout=views columns=2 view-cone=12 \
 *     zero-parallax-dioptre=3 ! fakesink
 * ]|
 * Elemental images for an array of lenses 15.5 pixels apart:
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=6 ! focalstackmux ! tee name=s \
 *     s. ! queue ! dffdepth ! tee name=d  d. ! queue ! a.depth  s. ! queue ! a.stack \
 *     aifcompose name=a ! queue ! videoconvert ! l.color  d. ! queue ! l.depth \
 *     lightfieldcompose name=l layout=elemental pitch=15.5 grid=hex ! fakesink
 * ]|
 */
#include "lightfieldcompose.h"

#include "depth_matching.h"
#include "display_preset.h"
#include "gstcl/engine_message.h"
#include "light_field_picture.h"
#include "lightfieldcompose_properties.h"

#include <gst/dff/dff.h>
#include <mutex>
#include <optional>
#include <string>

GST_DEBUG_CATEGORY_STATIC(light_field_compose_debug);
#define GST_CAT_DEFAULT light_field_compose_debug

namespace {

enum Property : guint { PropertyDevice = dff::light_field_properties_end, PropertyFileSuffix, PropertyStats };

struct State {
    /* Guards the properties and statistics; nothing else is locked under it but the element's own lock. */
    std::mutex mutex;
    dff::LightFieldSettings settings;
    bool settings_changed = true;
    std::string device_wish;
    std::string file_suffix;
    guint64 pictures = 0;
    guint64 without_depth = 0;
    GstClockTime compute_time = 0;
    GstClockTime latency = 0;

    /* The streaming thread's own. */
    dff::LightFieldPicture picture;
    std::optional<dff::LightFieldPlan> plan; /* as of the last negotiation */
    bool has_color_caps = false;
};

} // namespace

struct _GstLightFieldCompose {
    GstAggregator parent;
    GstAggregatorPad *color_pad;
    GstAggregatorPad *depth_pad;
    State *state;
};

G_DEFINE_FINAL_TYPE(GstLightFieldCompose, gst_light_field_compose, GST_TYPE_AGGREGATOR)
GST_ELEMENT_REGISTER_DEFINE(lightfieldcompose, "lightfieldcompose", GST_RANK_NONE,
                            GST_TYPE_LIGHT_FIELD_COMPOSE)

#define COLOR_CAPS GST_VIDEO_CAPS_MAKE("{ RGBx, BGRx, RGB, BGR }")

static GstStaticPadTemplate color_template =
    GST_STATIC_PAD_TEMPLATE("color", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(COLOR_CAPS));
static GstStaticPadTemplate depth_template = GST_STATIC_PAD_TEMPLATE(
    "depth", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("GRAY16_LE")));
static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(COLOR_CAPS));

static void account(GstLightFieldCompose *self, GstClockTime compute_time, bool with_depth)
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

/* Hands changed properties to the work. */
static void apply_settings(State &state)
{
    const std::lock_guard lock(state.mutex);
    if (state.settings_changed)
        state.picture.set_settings(state.settings);
    state.settings_changed = false;
}

static GstFlowReturn compose_and_push(GstLightFieldCompose *self, GstBuffer *color, GstBuffer *depth)
{
    State &state = *self->state;
    try {
        const GstClockTime start = gst_util_get_timestamp();
        apply_settings(state);
        GstBuffer *picture = state.picture.compose(color, depth);
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

static GstFlowReturn gst_light_field_compose_aggregate(GstAggregator *aggregator, gboolean)
{
    GstLightFieldCompose *self = GST_LIGHT_FIELD_COMPOSE(aggregator);
    g_autoptr(GstBuffer) color = gst_aggregator_pad_peek_buffer(self->color_pad);

    if (!color)
        return gst_aggregator_pad_is_eos(self->color_pad) ? GST_FLOW_EOS : GST_AGGREGATOR_FLOW_NEED_DATA;
    if (!self->state->has_color_caps)
        return GST_FLOW_NOT_NEGOTIATED;
    if (gst_buffer_get_size(color) == 0) { /* a gap */
        gst_aggregator_pad_drop_buffer(self->color_pad);
        return GST_FLOW_OK;
    }
    const std::optional<GstBuffer *> match = dff::matching_depth(self->color_pad, color, self->depth_pad);
    if (!match)
        return GST_AGGREGATOR_FLOW_NEED_DATA;
    g_autoptr(GstBuffer) depth = *match;
    gst_aggregator_pad_drop_buffer(self->color_pad);
    return compose_and_push(self, color, depth);
}

static gboolean set_color_caps(GstLightFieldCompose *self, const GstCaps *caps)
{
    GstVideoInfo info;
    if (!gst_video_info_from_caps(&info, caps))
        return FALSE;
    self->state->picture.set_color(info);
    self->state->has_color_caps = true;
    gst_pad_mark_reconfigure(GST_AGGREGATOR_SRC_PAD(self));
    return TRUE;
}

static gboolean set_depth_caps(GstLightFieldCompose *self, const GstCaps *caps)
{
    GstVideoInfo info;
    GstDepthInfo facts;
    if (!gst_video_info_from_caps(&info, caps))
        return FALSE;
    gst_depth_info_init(&facts);
    gst_depth_info_from_caps(&facts, caps);
    self->state->picture.set_depth(info, facts);
    return TRUE;
}

/* What the plan makes of the colour's caps. */
static GstCaps *output_caps(const GstVideoInfo &color, const dff::LightFieldPlan &plan)
{
    GstVideoInfo info = color;
    GST_VIDEO_INFO_WIDTH(&info) = static_cast<gint>(plan.output.width);
    GST_VIDEO_INFO_HEIGHT(&info) = static_cast<gint>(plan.output.height);
    GST_VIDEO_INFO_PAR_N(&info) = GST_VIDEO_INFO_PAR_D(&info) = 1;
    GstCaps *caps = gst_video_info_to_caps(&info);
    if (plan.any_size)
        gst_caps_set_simple(caps, "width", GST_TYPE_INT_RANGE, 1, G_MAXINT, "height", GST_TYPE_INT_RANGE, 1,
                            G_MAXINT, nullptr);
    return caps;
}

static GstFlowReturn gst_light_field_compose_update_src_caps(GstAggregator *aggregator, GstCaps *downstream,
                                                             GstCaps **caps)
{
    State &state = *GST_LIGHT_FIELD_COMPOSE(aggregator)->state;
    if (!state.has_color_caps)
        return GST_AGGREGATOR_FLOW_NEED_DATA;
    try {
        apply_settings(state);
        state.plan = state.picture.plan();
        g_autoptr(GstCaps) possible = output_caps(state.picture.color(), *state.plan);
        *caps = downstream ? gst_caps_intersect(possible, downstream) : gst_caps_ref(possible);
        return GST_FLOW_OK;
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(aggregator, RESOURCE, SETTINGS, ("%s", error.what()), (nullptr));
        return GST_FLOW_ERROR;
    }
}

static GstCaps *gst_light_field_compose_fixate_src_caps(GstAggregator *aggregator, GstCaps *caps)
{
    const dff::LightFieldPlan &plan = *GST_LIGHT_FIELD_COMPOSE(aggregator)->state->plan;
    caps = gst_caps_make_writable(gst_caps_truncate(caps));
    GstStructure *structure = gst_caps_get_structure(caps, 0);
    gst_structure_fixate_field_nearest_int(structure, "width", static_cast<gint>(plan.output.width));
    gst_structure_fixate_field_nearest_int(structure, "height", static_cast<gint>(plan.output.height));
    return gst_caps_fixate(caps);
}

/* The suffix that tells players how the quilt is laid out; empty in other layouts. */
static std::string suffix_of(const dff::LightFieldPlan &plan, const GstVideoInfo &color)
{
    if (plan.parameters.layout != dff::LightFieldLayout::Quilt)
        return "";
    const double aspect =
        plan.parameters.view_aspect > 0.0
            ? plan.parameters.view_aspect
            : static_cast<double>(GST_VIDEO_INFO_WIDTH(&color)) / GST_VIDEO_INFO_HEIGHT(&color);
    return dff::quilt_suffix(plan.parameters.columns, plan.parameters.rows, aspect);
}

static gboolean gst_light_field_compose_negotiated_src_caps(GstAggregator *aggregator, GstCaps *caps)
{
    State &state = *GST_LIGHT_FIELD_COMPOSE(aggregator)->state;
    GstVideoInfo info;
    if (!gst_video_info_from_caps(&info, caps))
        return FALSE;
    const dff::LightFieldPlan &plan = *state.plan;
    const dff::LightFieldParameters &wanted = plan.parameters;
    const bool is_quilt = wanted.layout == dff::LightFieldLayout::Quilt;
    const guint columns = is_quilt || wanted.layout == dff::LightFieldLayout::Views ? wanted.columns : 1;
    const guint rows = is_quilt ? wanted.rows : 1;
    if (GST_VIDEO_INFO_WIDTH(&info) < static_cast<gint>(columns) ||
        GST_VIDEO_INFO_HEIGHT(&info) < static_cast<gint>(rows)) {
        GST_ELEMENT_ERROR(aggregator, STREAM, FORMAT,
                          ("%dx%d pixels are too few for %u columns and %u rows of views",
                           GST_VIDEO_INFO_WIDTH(&info), GST_VIDEO_INFO_HEIGHT(&info), columns, rows),
                          (nullptr));
        return FALSE;
    }
    state.picture.set_output(info);
    const std::lock_guard lock(state.mutex);
    state.file_suffix = suffix_of(plan, state.picture.color());
    return TRUE;
}

static gboolean gst_light_field_compose_sink_event(GstAggregator *aggregator, GstAggregatorPad *pad,
                                                   GstEvent *event)
{
    GstLightFieldCompose *self = GST_LIGHT_FIELD_COMPOSE(aggregator);

    if (GST_EVENT_TYPE(event) == GST_EVENT_CAPS) {
        GstCaps *caps = nullptr;
        gst_event_parse_caps(event, &caps);
        const gboolean accepted =
            pad == self->color_pad ? set_color_caps(self, caps) : set_depth_caps(self, caps);
        gst_event_unref(event);
        return accepted;
    }
    if (GST_EVENT_TYPE(event) == GST_EVENT_SEGMENT && pad == self->color_pad) {
        const GstSegment *segment = nullptr;
        gst_event_parse_segment(event, &segment);
        if (segment->format == GST_FORMAT_TIME)
            gst_aggregator_update_segment(aggregator, segment);
    }
    return GST_AGGREGATOR_CLASS(gst_light_field_compose_parent_class)->sink_event(aggregator, pad, event);
}

static gboolean gst_light_field_compose_propose_allocation(GstAggregator *, GstAggregatorPad *, GstQuery *,
                                                           GstQuery *query)
{
    gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
    return TRUE;
}

static gboolean gst_light_field_compose_start(GstAggregator *aggregator)
{
    GstLightFieldCompose *self = GST_LIGHT_FIELD_COMPOSE(aggregator);
    State &state = *self->state;
    for (GstAggregatorPad *pad : {self->color_pad, self->depth_pad})
        if (!gst_pad_is_linked(GST_PAD(pad))) {
            GST_ELEMENT_ERROR(
                self, CORE, PAD,
                ("The pad \"%s\" is not linked: lightfieldcompose needs a colour picture and its depth",
                 GST_PAD_NAME(pad)),
                (nullptr));
            return FALSE;
        }
    try {
        const std::lock_guard lock(state.mutex);
        dff::LightFieldPlan(state.settings, {1, 1}); /* tells of a calibration that cannot be read */
        state.settings_changed = true;
        state.picture.start(dff::Device::open(state.device_wish));
    } catch (const dff::EngineError &error) {
        dff::post_engine_error(GST_ELEMENT(self), error);
        return FALSE;
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("%s", error.what()), (nullptr));
        return FALSE;
    }
    return TRUE;
}

static gboolean gst_light_field_compose_stop(GstAggregator *aggregator)
{
    State &state = *GST_LIGHT_FIELD_COMPOSE(aggregator)->state;
    state.picture.stop();
    state.has_color_caps = false;
    const std::lock_guard lock(state.mutex);
    state.pictures = state.without_depth = 0;
    state.latency = 0;
    return TRUE;
}

static void gst_light_field_compose_set_property(GObject *object, guint id, const GValue *value,
                                                 GParamSpec *pspec)
{
    State &state = *GST_LIGHT_FIELD_COMPOSE(object)->state;
    {
        const std::lock_guard lock(state.mutex);
        if (dff::set_light_field_property(state.settings, id, value))
            state.settings_changed = true;
        else if (id == PropertyDevice)
            state.device_wish = g_value_get_string(value) ? g_value_get_string(value) : "";
        else
            G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
    }
    gst_pad_mark_reconfigure(GST_AGGREGATOR_SRC_PAD(object)); /* the size may be another now */
}

static void gst_light_field_compose_get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    State &state = *GST_LIGHT_FIELD_COMPOSE(object)->state;
    const std::lock_guard lock(state.mutex);
    if (dff::get_light_field_property(state.settings, id, value))
        return;
    if (id == PropertyDevice)
        g_value_set_string(value, state.device_wish.c_str());
    else if (id == PropertyFileSuffix)
        g_value_set_string(value, state.file_suffix.c_str());
    else if (id == PropertyStats)
        g_value_take_boxed(value, gst_structure_new("lightfieldcompose-stats", "pictures", G_TYPE_UINT64,
                                                    state.pictures, "without-depth", G_TYPE_UINT64,
                                                    state.without_depth, "compute-ms", G_TYPE_DOUBLE,
                                                    static_cast<gdouble>(state.compute_time) / 1e6, nullptr));
    else
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void gst_light_field_compose_finalize(GObject *object)
{
    delete GST_LIGHT_FIELD_COMPOSE(object)->state;
    G_OBJECT_CLASS(gst_light_field_compose_parent_class)->finalize(object);
}

/* Always pads, built here so that they keep their names. */
static GstAggregatorPad *add_sink(GstLightFieldCompose *self, GstStaticPadTemplate *static_template)
{
    g_autoptr(GstPadTemplate) pad_template = gst_static_pad_template_get(static_template);
    GstPad *pad = GST_PAD(g_object_new(GST_TYPE_AGGREGATOR_PAD, "name", static_template->name_template,
                                       "direction", GST_PAD_SINK, "template", pad_template, nullptr));
    gst_element_add_pad(GST_ELEMENT(self), pad);
    return GST_AGGREGATOR_PAD(pad);
}

static void gst_light_field_compose_init(GstLightFieldCompose *self)
{
    self->state = new State;
    self->color_pad = add_sink(self, &color_template);
    self->depth_pad = add_sink(self, &depth_template);
}

static void install_own_properties(GObjectClass *object_class)
{
    g_object_class_install_property(
        object_class, PropertyDevice,
        g_param_spec_string(
            "device", "Device",
            "Part of the name of the OpenCL device to compute on, as clinfo -l lists it; empty: the first "
            "GPU, else the CPU",
            "",
            static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY)));
    g_object_class_install_property(
        object_class, PropertyFileSuffix,
        g_param_spec_string(
            "file-suffix", "File suffix",
            "What players of quilts want before the dot of a file's name, such as _qs8x6a0.75; empty in "
            "other layouts and before the first picture",
            "", static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));
    g_object_class_install_property(
        object_class, PropertyStats,
        g_param_spec_boxed(
            "stats", "Stats", "Pictures so far, those without any depth, and milliseconds the last one took",
            GST_TYPE_STRUCTURE, static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));
}

static void gst_light_field_compose_class_init(GstLightFieldComposeClass *klass)
{
    GObjectClass *object_class = G_OBJECT_CLASS(klass);
    GstElementClass *element_class = GST_ELEMENT_CLASS(klass);
    GstAggregatorClass *aggregator_class = GST_AGGREGATOR_CLASS(klass);

    GST_DEBUG_CATEGORY_INIT(light_field_compose_debug, "lightfieldcompose", 0,
                            "pictures for light-field displays");
    object_class->set_property = gst_light_field_compose_set_property;
    object_class->get_property = gst_light_field_compose_get_property;
    object_class->finalize = gst_light_field_compose_finalize;
    aggregator_class->aggregate = gst_light_field_compose_aggregate;
    aggregator_class->update_src_caps = gst_light_field_compose_update_src_caps;
    aggregator_class->fixate_src_caps = gst_light_field_compose_fixate_src_caps;
    aggregator_class->negotiated_src_caps = gst_light_field_compose_negotiated_src_caps;
    aggregator_class->sink_event = gst_light_field_compose_sink_event;
    aggregator_class->propose_allocation = gst_light_field_compose_propose_allocation;
    aggregator_class->start = gst_light_field_compose_start;
    aggregator_class->stop = gst_light_field_compose_stop;
    dff::install_light_field_properties(object_class);
    install_own_properties(object_class);

    for (GstStaticPadTemplate *pad_template : {&color_template, &depth_template, &src_template})
        gst_element_class_add_static_pad_template_with_gtype(element_class, pad_template,
                                                             GST_TYPE_AGGREGATOR_PAD);
    gst_element_class_set_static_metadata(
        element_class, "Light-field composer", "Filter/Editor/Video/Compositor",
        "Makes pictures for light-field displays of colour and depth", "the gst-plugins-dff authors");
}
