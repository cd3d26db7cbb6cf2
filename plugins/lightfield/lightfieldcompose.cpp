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
 * so on. A picture without depth comes out flat. Put a queue on every branch. Pictures of up to 8192x8192
 * pixels come in, those that go out may have 16384x16384, in the colours' own format or another that
 * downstream wants. An element message, lightfieldcompose-disparity, tells at the start and whenever it
 * changes how far the ends of the sweep move between the outermost views, and how far they may and still look
 * sharp (disparity, sharp-disparity: pixels of a view or of the panel); beyond that, a warning follows. The
 * OpenCL device is shared with the neighbours, or given by the application: see
 * gst_context_new_dff_device().
 *
 * A quilt for a Looking Glass Portrait, at half its usual size; file-suffix is what players want at the end
 * of its name:
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=6 ! focalstackmux ! tee name=s \
 *     s. ! queue ! dffdepth ! tee name=d  d. ! queue ! a.depth  s. ! queue ! a.stack \
 *     aifcompose name=a ! queue ! l.color  d. ! queue ! l.depth \
 *     lightfieldcompose name=l preset=looking-glass-portrait ! video/x-raw,width=1680,height=1680 ! \
 *     videoconvert ! pngenc ! filesink location=shapes_qs8x6a0.75.png
 * ]|
 * Stereo, with what lies at three dioptres in the plane of the screen:
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=6 ! focalstackmux ! tee name=s \
 *     s. ! queue ! dffdepth ! tee name=d  d. ! queue ! a.depth  s. ! queue ! a.stack \
 *     aifcompose name=a ! queue ! l.color  d. ! queue ! l.depth \
 *     lightfieldcompose name=l layout=views columns=2 view-cone=12 \
 *     zero-parallax-dioptre=3 ! fakesink
 * ]|
 * Elemental images for an array of lenses 15.5 pixels apart:
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=6 ! focalstackmux ! tee name=s \
 *     s. ! queue ! dffdepth ! tee name=d  d. ! queue ! a.depth  s. ! queue ! a.stack \
 *     aifcompose name=a ! queue ! l.color  d. ! queue ! l.depth \
 *     lightfieldcompose name=l layout=elemental pitch=15.5 grid=hex ! fakesink
 * ]|
 */
#include "lightfieldcompose.h"

#include "depth_matching.h"
#include "disparity_message.h"
#include "display_preset.h"
#include "gstcl/depth_composer.h"
#include "light_field_caps.h"
#include "light_field_picture.h"
#include "lightfieldcompose_properties.h"

#include <gst/dff/dff.h>

GST_DEBUG_CATEGORY_STATIC(light_field_compose_debug);
#define GST_CAT_DEFAULT light_field_compose_debug

static GstStaticPadTemplate color_template =
    GST_STATIC_PAD_TEMPLATE("color", GST_PAD_SINK, GST_PAD_ALWAYS,
                            GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("{ " DFF_RGB_FORMATS ", I420, NV12 }")));
static GstStaticPadTemplate depth_template = GST_STATIC_PAD_TEMPLATE(
    "depth", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("GRAY16_LE")));
static GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("{ " DFF_RGB_FORMATS " }")));

namespace {

enum Property : guint { PropertyDevice = dff::light_field_properties_end, PropertyFileSuffix, PropertyStats };

class State : public dff::DepthComposer {
public:
    explicit State(GstAggregator *element)
        : DepthComposer(element, &color_template, &depth_template, "a colour picture and its depth"),
          element_(element)
    {
    }

    /* The properties of light_field_settings.h and file-suffix; false for others. */
    bool set_property(guint id, const GValue *value);
    bool get_property(guint id, GValue *value);

    /* Makes the plan that the next three speak of. Throws std::runtime_error. */
    void make_plan();
    const dff::LightFieldPlan &plan() const { return *plan_; }
    const GstVideoInfo &color() const { return picture_.color(); }
    void set_output(const GstVideoInfo &info);

private:
    void open_device(std::shared_ptr<dff::Device> device) override;
    void close_device() override;
    bool set_main_caps(const GstCaps *caps) override;
    bool set_depth_caps(const GstCaps *caps) override;
    std::optional<GstBuffer *> matching_depth(GstAggregatorPad *color_pad, GstBuffer *color,
                                              GstAggregatorPad *depth_pad) override
    {
        return dff::matching_depth(color_pad, color, depth_pad);
    }
    GstBuffer *compose(GstBuffer *color, GstBuffer *depth) override;
    void add_stats(GstStructure *stats) const override { dff::add_disparity(stats, disparity_); }
    void tell_disparity();
    void apply_settings();

    GstAggregator *element_; /* which owns this */

    /* Under the mutex. */
    dff::LightFieldSettings settings_;
    bool settings_changed_ = true;
    std::string file_suffix_;
    dff::LightFieldDisparity disparity_; /* as it was told last */

    /* The streaming thread's own. */
    dff::LightFieldPicture picture_;
    std::optional<dff::LightFieldPlan> plan_; /* as of the last negotiation */
};

bool State::set_property(guint id, const GValue *value)
{
    const std::lock_guard lock(mutex);
    if (!dff::set_light_field_property(settings_, id, value))
        return false;
    settings_changed_ = true;
    return true;
}

bool State::get_property(guint id, GValue *value)
{
    const std::lock_guard lock(mutex);
    if (id != PropertyFileSuffix)
        return dff::get_light_field_property(settings_, id, value);
    g_value_set_string(value, file_suffix_.c_str());
    return true;
}

/* Hands changed properties to the work. */
void State::apply_settings()
{
    const std::lock_guard lock(mutex);
    if (settings_changed_)
        picture_.set_settings(settings_);
    settings_changed_ = false;
}

void State::open_device(std::shared_ptr<dff::Device> device)
{
    /* Tells of a calibration that cannot be read. */
    [[maybe_unused]] const dff::LightFieldPlan plan(settings_, {1, 1});
    settings_changed_ = true;
    picture_.start(std::move(device));
}

void State::close_device()
{
    picture_.stop();
    const std::lock_guard lock(mutex);
    disparity_ = {}; /* told anew at the next start */
}

bool State::set_main_caps(const GstCaps *caps)
{
    GstVideoInfo info;
    if (!gst_video_info_from_caps(&info, caps))
        return false;
    GST_INFO_OBJECT(element_, "colour: %" GST_PTR_FORMAT, caps);
    try {
        picture_.set_color(info);
        return true;
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(element_, STREAM, FORMAT, ("%s", error.what()), (nullptr));
        return false;
    }
}

bool State::set_depth_caps(const GstCaps *caps)
{
    GstVideoInfo info;
    GstDepthInfo facts;
    if (!gst_video_info_from_caps(&info, caps))
        return false;
    GST_INFO_OBJECT(element_, "depth: %" GST_PTR_FORMAT, caps);
    gst_depth_info_init(&facts);
    gst_depth_info_from_caps(&facts, caps);
    picture_.set_depth(info, facts);
    return true;
}

GstBuffer *State::compose(GstBuffer *color, GstBuffer *depth)
{
    apply_settings();
    GST_LOG_OBJECT(element_, "%" GST_PTR_FORMAT " with %" GST_PTR_FORMAT, color, depth);
    GstBuffer *picture = picture_.compose(color, depth);
    tell_disparity();
    return picture;
}

/* Once a change. */
void State::tell_disparity()
{
    {
        const std::lock_guard lock(mutex);
        if (picture_.disparity() == disparity_)
            return;
        disparity_ = picture_.disparity();
    }
    dff::post_disparity(GST_ELEMENT(element_), picture_.disparity());
}

void State::make_plan()
{
    apply_settings();
    plan_ = picture_.plan();
}

/* The suffix that tells players how the quilt is laid out; empty in other layouts. */
std::string suffix_of(const dff::LightFieldPlan &plan, const GstVideoInfo &color)
{
    if (plan.parameters.layout != dff::LightFieldLayout::Quilt)
        return "";
    const double aspect =
        plan.parameters.view_aspect > 0.0
            ? plan.parameters.view_aspect
            : static_cast<double>(GST_VIDEO_INFO_WIDTH(&color)) / GST_VIDEO_INFO_HEIGHT(&color);
    return dff::quilt_suffix(plan.parameters.columns, plan.parameters.rows, aspect);
}

void State::set_output(const GstVideoInfo &info)
{
    picture_.set_output(info);
    const std::lock_guard lock(mutex);
    file_suffix_ = suffix_of(*plan_, picture_.color());
}

} // namespace

struct _GstLightFieldCompose {
    GstAggregator parent;
    State *state;
};

G_DEFINE_FINAL_TYPE(GstLightFieldCompose, gst_light_field_compose, GST_TYPE_AGGREGATOR)
GST_ELEMENT_REGISTER_DEFINE(lightfieldcompose, "lightfieldcompose", GST_RANK_NONE,
                            GST_TYPE_LIGHT_FIELD_COMPOSE)

static GstFlowReturn gst_light_field_compose_aggregate(GstAggregator *aggregator, gboolean)
{
    return GST_LIGHT_FIELD_COMPOSE(aggregator)->state->aggregate();
}

static GstFlowReturn gst_light_field_compose_update_src_caps(GstAggregator *aggregator, GstCaps *downstream,
                                                             GstCaps **caps)
{
    State &state = *GST_LIGHT_FIELD_COMPOSE(aggregator)->state;
    if (!state.has_main_caps())
        return GST_AGGREGATOR_FLOW_NEED_DATA;
    try {
        state.make_plan();
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(aggregator, RESOURCE, SETTINGS, ("%s", error.what()), (nullptr));
        return GST_FLOW_ERROR;
    }
    g_autoptr(GstCaps) possible = dff::light_field_caps(state.color(), state.plan());
    *caps = downstream ? gst_caps_intersect_full(possible, downstream, GST_CAPS_INTERSECT_FIRST)
                       : gst_caps_ref(possible);
    if (!gst_caps_is_empty(*caps))
        return GST_FLOW_OK;
    g_autofree gchar *wanted = gst_caps_to_string(downstream);
    GST_ELEMENT_ERROR(aggregator, CORE, NEGOTIATION,
                      ("This layout gives pictures of %ux%u pixels in RGBx, BGRx, RGB or BGR, and what comes "
                       "after takes none of them",
                       state.plan().output.width, state.plan().output.height),
                      ("downstream takes %s", wanted));
    return GST_FLOW_ERROR;
}

static GstCaps *gst_light_field_compose_fixate_src_caps(GstAggregator *aggregator, GstCaps *caps)
{
    return dff::fixate_light_field_caps(caps, GST_LIGHT_FIELD_COMPOSE(aggregator)->state->plan());
}

static gboolean gst_light_field_compose_negotiated_src_caps(GstAggregator *aggregator, GstCaps *caps)
{
    State &state = *GST_LIGHT_FIELD_COMPOSE(aggregator)->state;
    GstVideoInfo info;
    if (!gst_video_info_from_caps(&info, caps))
        return FALSE;
    const dff::LightFieldParameters &wanted = state.plan().parameters;
    const bool has_views =
        wanted.layout == dff::LightFieldLayout::Quilt || wanted.layout == dff::LightFieldLayout::Views;
    const guint columns = has_views ? wanted.columns : 1, rows = has_views ? wanted.rows : 1;
    if (GST_VIDEO_INFO_WIDTH(&info) < static_cast<gint>(columns) ||
        GST_VIDEO_INFO_HEIGHT(&info) < static_cast<gint>(rows)) {
        GST_ELEMENT_ERROR(aggregator, STREAM, FORMAT,
                          ("%dx%d pixels are too few for %u columns and %u rows of views",
                           GST_VIDEO_INFO_WIDTH(&info), GST_VIDEO_INFO_HEIGHT(&info), columns, rows),
                          (nullptr));
        return FALSE;
    }
    GST_INFO_OBJECT(aggregator, "output: %" GST_PTR_FORMAT, caps);
    try {
        state.set_output(info);
        return TRUE;
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(aggregator, STREAM, FORMAT, ("%s", error.what()), (nullptr));
        return FALSE;
    }
}

static gboolean gst_light_field_compose_sink_event(GstAggregator *aggregator, GstAggregatorPad *pad,
                                                   GstEvent *event)
{
    if (const auto taken = GST_LIGHT_FIELD_COMPOSE(aggregator)->state->sink_event(pad, event))
        return *taken;
    return GST_AGGREGATOR_CLASS(gst_light_field_compose_parent_class)->sink_event(aggregator, pad, event);
}

static gboolean gst_light_field_compose_src_event(GstAggregator *aggregator, GstEvent *event)
{
    if (const auto taken = GST_LIGHT_FIELD_COMPOSE(aggregator)->state->src_event(event))
        return *taken;
    return GST_AGGREGATOR_CLASS(gst_light_field_compose_parent_class)->src_event(aggregator, event);
}

static gboolean gst_light_field_compose_sink_query(GstAggregator *aggregator, GstAggregatorPad *pad,
                                                   GstQuery *query)
{
    return GST_LIGHT_FIELD_COMPOSE(aggregator)->state->answer(query) ||
           GST_AGGREGATOR_CLASS(gst_light_field_compose_parent_class)->sink_query(aggregator, pad, query);
}

static gboolean gst_light_field_compose_src_query(GstAggregator *aggregator, GstQuery *query)
{
    return GST_LIGHT_FIELD_COMPOSE(aggregator)->state->answer(query) ||
           GST_AGGREGATOR_CLASS(gst_light_field_compose_parent_class)->src_query(aggregator, query);
}

static gboolean gst_light_field_compose_start(GstAggregator *aggregator)
{
    return GST_LIGHT_FIELD_COMPOSE(aggregator)->state->start();
}

static gboolean gst_light_field_compose_stop(GstAggregator *aggregator)
{
    GST_LIGHT_FIELD_COMPOSE(aggregator)->state->stop();
    return TRUE;
}

static void gst_light_field_compose_set_property(GObject *object, guint id, const GValue *value,
                                                 GParamSpec *pspec)
{
    State &state = *GST_LIGHT_FIELD_COMPOSE(object)->state;
    if (id == PropertyDevice)
        state.set_device(value);
    else if (state.set_property(id, value))
        gst_pad_mark_reconfigure(GST_AGGREGATOR_SRC_PAD(object)); /* the size may be another now */
    else
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void gst_light_field_compose_get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    State &state = *GST_LIGHT_FIELD_COMPOSE(object)->state;
    if (id == PropertyDevice)
        state.get_device(value);
    else if (id == PropertyStats)
        state.get_stats(value);
    else if (!state.get_property(id, value))
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void gst_light_field_compose_finalize(GObject *object)
{
    delete GST_LIGHT_FIELD_COMPOSE(object)->state;
    G_OBJECT_CLASS(gst_light_field_compose_parent_class)->finalize(object);
}

static void gst_light_field_compose_init(GstLightFieldCompose *self)
{
    self->state = new State(GST_AGGREGATOR(self));
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
    aggregator_class->src_event = gst_light_field_compose_src_event;
    aggregator_class->sink_query = gst_light_field_compose_sink_query;
    aggregator_class->src_query = gst_light_field_compose_src_query;
    aggregator_class->propose_allocation = dff::DepthComposer::propose_allocation;
    aggregator_class->start = gst_light_field_compose_start;
    aggregator_class->stop = gst_light_field_compose_stop;
    dff::install_light_field_properties(object_class);
    dff::DepthComposer::install_properties(object_class, PropertyDevice, PropertyStats);
    g_object_class_install_property(
        object_class, PropertyFileSuffix,
        g_param_spec_string(
            "file-suffix", "File suffix",
            "What players of quilts want before the dot of a file's name, such as _qs8x6a0.75; empty in "
            "other layouts and before the first picture",
            "", static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));

    for (GstStaticPadTemplate *pad_template : {&color_template, &depth_template, &src_template})
        gst_element_class_add_static_pad_template_with_gtype(element_class, pad_template,
                                                             GST_TYPE_AGGREGATOR_PAD);
    gst_element_class_set_static_metadata(
        element_class, "Light-field composer", "Filter/Editor/Video/Compositor",
        "Makes pictures for light-field displays of colour and depth", "the gst-plugins-dff authors");
}
