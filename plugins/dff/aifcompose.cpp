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
 * The OpenCL device is shared with the neighbours, or given by the application: see
 * gst_context_new_dff_device().
 *
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=60 ! focalstackmux ! tee name=s \
 *     s. ! queue ! dffdepth ! queue ! c.depth  s. ! queue ! c.stack \
 *     aifcompose name=c ! videoconvert ! fakesink
 * ]|
 */
#include "aifcompose.h"

#include "aif_picture.h"
#include "common/running_time.h"
#include "gstcl/depth_composer.h"
#include "gstcl/engine_caps.h"
#include "number_matching.h"

#include <gst/dff/dff.h>
#include <utility>

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

static GstStaticPadTemplate stack_template =
    GST_STATIC_PAD_TEMPLATE("stack", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(ENGINE_STACK_CAPS));
static GstStaticPadTemplate depth_template = GST_STATIC_PAD_TEMPLATE(
    "depth", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("GRAY16_LE")));
static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS,
                            GST_STATIC_CAPS("video/x-raw, format = (string) " GST_FOCAL_STACK_FORMATS
                                            ", " ENGINE_SIZES ", framerate = (fraction) [ 0, max ]"));

namespace {

enum Property : guint { PropertyBlend = 1, PropertyDevice, PropertyStats };

class State : public dff::DepthComposer {
public:
    explicit State(GstAggregator *element)
        : DepthComposer(element, &stack_template, &depth_template, "a stack and its depth"), element_(element)
    {
    }

    void set_blend(dff::AifComposer::Blend blend)
    {
        const std::lock_guard lock(mutex);
        blend_ = blend;
    }

    dff::AifComposer::Blend blend()
    {
        const std::lock_guard lock(mutex);
        return blend_;
    }

    const GstVideoInfo &frame() const { return picture_.stack().frame; }

private:
    void open_device(std::shared_ptr<dff::Device> device) override
    {
        GST_INFO_OBJECT(element_, "composing on %s", device->name().c_str());
        picture_.start(std::move(device));
    }
    void close_device() override;
    bool set_main_caps(const GstCaps *caps) override;
    bool set_depth_caps(const GstCaps *caps) override;
    std::optional<GstBuffer *> matching_depth(GstAggregatorPad *stack_pad, GstBuffer *stack,
                                              GstAggregatorPad *depth_pad) override;
    std::optional<GstBuffer *> next_depth(GstAggregatorPad *stack_pad, GstBuffer *stack,
                                          GstAggregatorPad *depth_pad);
    bool is_usable(GstBuffer *stack, GstBuffer *depth);
    GstBuffer *compose(GstBuffer *stack, GstBuffer *depth) override
    {
        GST_LOG_OBJECT(element_, "a picture of %" GST_PTR_FORMAT " %s", stack,
                       depth ? "by its depth" : "without depth");
        return picture_.compose(stack, depth, blend());
    }

    dff::AifComposer::Blend blend_ = dff::AifComposer::Blend::Soft; /* under the mutex */

    /* The streaming thread's own. */
    dff::AifPicture picture_;
    dff::NumberMatching matching_;
    std::string last_warning_;
    GstAggregator *element_; /* which owns this */
};

void State::close_device()
{
    picture_.stop();
    matching_ = {};
    last_warning_.clear();
}

bool State::set_main_caps(const GstCaps *caps)
{
    GstFocalStackInfo info;
    if (!gst_focal_stack_info_from_caps(&info, caps))
        return false;
    if (const auto problem = dff::wrong_size(info.frame)) {
        GST_ELEMENT_ERROR(element_, STREAM, FORMAT, ("%s", problem->c_str()), (nullptr));
        return false;
    }
    GST_INFO_OBJECT(element_, "stacks are %" GST_PTR_FORMAT, caps);
    picture_.set_stack(info);
    return true;
}

bool State::set_depth_caps(const GstCaps *caps)
{
    GstVideoInfo info;
    GstDepthInfo facts;
    if (!gst_video_info_from_caps(&info, caps))
        return false;
    gst_depth_info_init(&facts);
    gst_depth_info_from_caps(&facts, caps);
    GST_INFO_OBJECT(element_, "depth is %" GST_PTR_FORMAT, caps);
    picture_.set_depth(info, facts);
    return true;
}

/* Running time, since the pads' segments may differ. */
std::optional<uint64_t> time_of(GstAggregatorPad *pad, GstBuffer *buffer)
{
    const GstClockTime time = dff::running_time(pad->segment, GST_BUFFER_PTS(buffer));
    return GST_CLOCK_TIME_IS_VALID(time) ? std::optional(time) : std::nullopt;
}

std::optional<GstBuffer *> State::matching_depth(GstAggregatorPad *stack_pad, GstBuffer *stack,
                                                 GstAggregatorPad *depth_pad)
{
    const std::optional<GstBuffer *> found = next_depth(stack_pad, stack, depth_pad);
    if (!found)
        return std::nullopt;
    if (const GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(stack))
        matching_.pass_stack(meta->sequence);
    if (!*found || is_usable(stack, *found))
        return found;
    gst_buffer_unref(*found);
    return nullptr;
}

/* By number; without metas the first goes with the first. */
std::optional<GstBuffer *> State::next_depth(GstAggregatorPad *stack_pad, GstBuffer *stack,
                                             GstAggregatorPad *depth_pad)
{
    using Order = dff::NumberMatching::Order;
    const GstFocalStackMeta *stack_meta = gst_buffer_get_focal_stack_meta(stack);

    while (GstBuffer *depth = gst_aggregator_pad_peek_buffer(depth_pad)) {
        const GstDepthMeta *depth_meta = gst_buffer_get_depth_meta(depth);
        const bool is_gap = gst_buffer_get_size(depth) == 0;
        const Order order = stack_meta && depth_meta
                                ? matching_.order({depth_meta->sequence, time_of(depth_pad, depth)},
                                                  {stack_meta->sequence, time_of(stack_pad, stack)})
                                : Order::Same;
        if (!is_gap && order == Order::Later) {
            GST_DEBUG_OBJECT(stack_pad,
                             "stack %" G_GUINT64_FORMAT " has no depth: the next is of %" G_GUINT64_FORMAT,
                             stack_meta->sequence, depth_meta->sequence);
            gst_buffer_unref(depth);
            return nullptr;
        }
        gst_aggregator_pad_drop_buffer(depth_pad);
        if (depth_meta)
            matching_.pass_depth(depth_meta->sequence);
        if (!is_gap && order == Order::Same)
            return depth;
        GST_DEBUG_OBJECT(depth_pad, "dropping a depth map without its stack, or a gap: %" GST_PTR_FORMAT,
                         depth);
        gst_buffer_unref(depth);
        if (is_gap && !stack_meta)
            return nullptr; /* the k-th with the k-th */
    }
    if (gst_aggregator_pad_is_eos(depth_pad))
        return nullptr;
    return std::nullopt;
}

/* Says once why not. */
bool State::is_usable(GstBuffer *stack, GstBuffer *depth)
{
    const std::optional<std::string> problem = picture_.take_facts(stack, depth);
    if (!problem)
        return true;
    GST_WARNING_OBJECT(element_, "a depth map cannot be read: %s", problem->c_str());
    if (std::exchange(last_warning_, *problem) != *problem)
        GST_ELEMENT_WARNING(element_, STREAM, FORMAT, ("A depth map cannot be read: %s", problem->c_str()),
                            ("The picture is the mean of the stack's planes."));
    return false;
}

} // namespace

struct _GstAifCompose {
    GstAggregator parent;
    State *state;
};

G_DEFINE_FINAL_TYPE(GstAifCompose, gst_aif_compose, GST_TYPE_AGGREGATOR)
GST_ELEMENT_REGISTER_DEFINE(aifcompose, "aifcompose", GST_RANK_NONE, GST_TYPE_AIF_COMPOSE)

static GstFlowReturn gst_aif_compose_aggregate(GstAggregator *aggregator, gboolean)
{
    return GST_AIF_COMPOSE(aggregator)->state->aggregate();
}

/* Without a word here nobody would say why nothing comes: the pads' threads learn it by their next buffer,
 * and the last stacks of a stream have none after them. */
static GstFlowReturn gst_aif_compose_update_src_caps(GstAggregator *aggregator, GstCaps *downstream,
                                                     GstCaps **caps)
{
    const State &state = *GST_AIF_COMPOSE(aggregator)->state;
    if (!state.has_main_caps())
        return GST_AGGREGATOR_FLOW_NEED_DATA;
    const GstVideoInfo &frame = state.frame();
    *caps = gst_video_info_to_caps(&frame);
    if (!downstream || gst_caps_can_intersect(*caps, downstream))
        return GST_FLOW_OK;
    GST_ELEMENT_ERROR(
        aggregator, CORE, NEGOTIATION,
        ("The pictures are %s of %dx%d pixels, as the stacks are, and what comes after does not "
         "take them: put videoconvert or videoscale behind this element",
         gst_video_format_to_string(GST_VIDEO_INFO_FORMAT(&frame)), GST_VIDEO_INFO_WIDTH(&frame),
         GST_VIDEO_INFO_HEIGHT(&frame)),
        ("downstream takes %" GST_PTR_FORMAT, downstream));
    return GST_FLOW_ERROR;
}

static gboolean gst_aif_compose_sink_event(GstAggregator *aggregator, GstAggregatorPad *pad, GstEvent *event)
{
    if (const auto taken = GST_AIF_COMPOSE(aggregator)->state->sink_event(pad, event))
        return *taken;
    return GST_AGGREGATOR_CLASS(gst_aif_compose_parent_class)->sink_event(aggregator, pad, event);
}

static gboolean gst_aif_compose_src_event(GstAggregator *aggregator, GstEvent *event)
{
    if (const auto taken = GST_AIF_COMPOSE(aggregator)->state->src_event(event))
        return *taken;
    return GST_AGGREGATOR_CLASS(gst_aif_compose_parent_class)->src_event(aggregator, event);
}

static gboolean gst_aif_compose_sink_query(GstAggregator *aggregator, GstAggregatorPad *pad, GstQuery *query)
{
    return GST_AIF_COMPOSE(aggregator)->state->answer(query) ||
           GST_AGGREGATOR_CLASS(gst_aif_compose_parent_class)->sink_query(aggregator, pad, query);
}

static gboolean gst_aif_compose_src_query(GstAggregator *aggregator, GstQuery *query)
{
    return GST_AIF_COMPOSE(aggregator)->state->answer(query) ||
           GST_AGGREGATOR_CLASS(gst_aif_compose_parent_class)->src_query(aggregator, query);
}

static gboolean gst_aif_compose_start(GstAggregator *aggregator)
{
    return GST_AIF_COMPOSE(aggregator)->state->start();
}

static gboolean gst_aif_compose_stop(GstAggregator *aggregator)
{
    GST_AIF_COMPOSE(aggregator)->state->stop();
    return TRUE;
}

static void gst_aif_compose_set_property(GObject *object, guint id, const GValue *value, GParamSpec *pspec)
{
    State &state = *GST_AIF_COMPOSE(object)->state;
    if (id == PropertyBlend)
        state.set_blend(static_cast<dff::AifComposer::Blend>(g_value_get_enum(value)));
    else if (id == PropertyDevice)
        state.set_device(value);
    else
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void gst_aif_compose_get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    State &state = *GST_AIF_COMPOSE(object)->state;
    if (id == PropertyBlend)
        g_value_set_enum(value, static_cast<int>(state.blend()));
    else if (id == PropertyDevice)
        state.get_device(value);
    else if (id == PropertyStats)
        state.get_stats(value);
    else
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void gst_aif_compose_finalize(GObject *object)
{
    delete GST_AIF_COMPOSE(object)->state;
    G_OBJECT_CLASS(gst_aif_compose_parent_class)->finalize(object);
}

static void gst_aif_compose_init(GstAifCompose *self)
{
    self->state = new State(GST_AGGREGATOR(self));
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
    aggregator_class->src_event = gst_aif_compose_src_event;
    aggregator_class->sink_query = gst_aif_compose_sink_query;
    aggregator_class->src_query = gst_aif_compose_src_query;
    aggregator_class->propose_allocation = dff::DepthComposer::propose_allocation;
    aggregator_class->start = gst_aif_compose_start;
    aggregator_class->stop = gst_aif_compose_stop;

    g_object_class_install_property(
        object_class, PropertyBlend,
        g_param_spec_enum("blend", "Blend", "How the planes around the depth are mixed", GST_TYPE_AIF_BLEND,
                          static_cast<int>(dff::AifComposer::Blend::Soft),
                          static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                   GST_PARAM_MUTABLE_PLAYING)));
    dff::DepthComposer::install_properties(object_class, PropertyDevice, PropertyStats);

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
