/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthfileenc.h"

#include "common/refused_seek.h"
#include "common/running_time.h"
#include "matched_inputs.h"

#include <optional>
#include <stdexcept>
#include <string>

GST_DEBUG_CATEGORY(dff_file_encoder_debug);
#define GST_CAT_DEFAULT dff_file_encoder_debug

namespace {

/* The streaming thread's own. */
struct State {
    std::optional<GstVideoInfo> colour;
    std::optional<GstVideoInfo> depth;
    std::optional<GstVideoInfo> uncertainty;
    std::optional<GstFocalStackInfo> stack;
    GstCaps *depth_caps = nullptr;

    ~State() { gst_clear_caps(&depth_caps); }
};

} // namespace

struct GstDepthFileEncPrivate {
    State *state;
};

G_DEFINE_ABSTRACT_TYPE_WITH_PRIVATE(GstDepthFileEnc, gst_depth_file_enc, GST_TYPE_AGGREGATOR)

static GstStaticPadTemplate colour_template = GST_STATIC_PAD_TEMPLATE(
    "color", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("RGB")));
static GstStaticPadTemplate depth_template = GST_STATIC_PAD_TEMPLATE(
    "depth", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("GRAY16_LE")));
static GstStaticPadTemplate uncertainty_template = GST_STATIC_PAD_TEMPLATE(
    "uncertainty", GST_PAD_SINK, GST_PAD_REQUEST, GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("GRAY16_LE")));

static State &state_of(GstDepthFileEnc *self)
{
    return *static_cast<GstDepthFileEncPrivate *>(gst_depth_file_enc_get_instance_private(self))->state;
}

/* The pad of that name, or nullptr. */
static dff::AggregatorPad find_pad(GstDepthFileEnc *self, const char *name)
{
    GstPad *pad = gst_element_get_static_pad(GST_ELEMENT(self), name);
    return dff::AggregatorPad(pad ? GST_AGGREGATOR_PAD(pad) : nullptr);
}

static std::string size_text(const GstVideoInfo &info)
{
    return std::to_string(GST_VIDEO_INFO_WIDTH(&info)) + "x" + std::to_string(GST_VIDEO_INFO_HEIGHT(&info));
}

static void check_sizes(const GstVideoInfo &colour, const GstVideoInfo &other, const char *name)
{
    if (size_text(colour) != size_text(other))
        throw std::runtime_error("color is " + size_text(colour) + " and " + name + " is " +
                                 size_text(other) + ": they must be of one size");
}

static GstFlowReturn push_file(GstDepthFileEnc *self, const dff::FrameSet &frames)
{
    auto *file = new std::vector<guint8>(GST_DEPTH_FILE_ENC_GET_CLASS(self)->encode(self, frames));
    GstBuffer *output = gst_buffer_new_wrapped_full(
        static_cast<GstMemoryFlags>(0), file->data(), file->size(), 0, file->size(), file,
        [](gpointer data) { delete static_cast<std::vector<guint8> *>(data); });
    gst_buffer_copy_into(output, frames.colour, GST_BUFFER_COPY_TIMESTAMPS, 0, static_cast<gsize>(-1));
    return gst_aggregator_finish_buffer(GST_AGGREGATOR(self), output);
}

static GstFlowReturn encode(GstDepthFileEnc *self, const dff::MatchedBuffers &buffers)
{
    const State &state = state_of(self);
    if (!state.colour || !state.depth || (buffers.stack && !state.stack) ||
        (buffers.uncertainty && !state.uncertainty))
        return GST_FLOW_NOT_NEGOTIATED;
    GST_LOG_OBJECT(self, "%" GST_PTR_FORMAT " with depth%s%s", buffers.colour.get(),
                   buffers.stack ? ", its stack" : "", buffers.uncertainty ? ", its uncertainty" : "");
    try {
        check_sizes(*state.colour, *state.depth, "depth");
        if (buffers.stack)
            check_sizes(*state.colour, state.stack->frame, "stack");
        if (buffers.uncertainty)
            check_sizes(*state.colour, *state.uncertainty, "uncertainty");
        return push_file(self,
                         {buffers.colour.get(), &*state.colour, buffers.depth.get(), &*state.depth,
                          state.depth_caps, buffers.stack.get(), buffers.stack ? &*state.stack : nullptr,
                          buffers.uncertainty.get(), buffers.uncertainty ? &*state.uncertainty : nullptr});
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, STREAM, ENCODE, ("%s", error.what()), (nullptr));
        return GST_FLOW_ERROR;
    }
}

static GstFlowReturn aggregate(GstAggregator *aggregator, gboolean)
{
    auto *self = GST_DEPTH_FILE_ENC(aggregator);
    const dff::InputPads pads{find_pad(self, "color"), find_pad(self, "depth"), find_pad(self, "stack"),
                              find_pad(self, "uncertainty")};
    dff::MatchedBuffers buffers;
    switch (dff::match_inputs(pads, buffers)) {
    case dff::Match::Waiting:
        return GST_AGGREGATOR_FLOW_NEED_DATA;
    case dff::Match::Again:
        return GST_FLOW_OK;
    case dff::Match::Ended:
        return GST_FLOW_EOS;
    case dff::Match::Ready:
        break;
    }
    return encode(self, buffers);
}

static bool set_caps(GstDepthFileEnc *self, const char *pad, GstCaps *caps)
{
    State &state = state_of(self);
    if (g_str_equal(pad, "stack")) {
        GstFocalStackInfo stack;
        state.stack.reset();
        if (gst_focal_stack_info_from_caps(&stack, caps))
            state.stack = stack;
        return state.stack.has_value();
    }
    GstVideoInfo info;
    if (!gst_video_info_from_caps(&info, caps))
        return false;
    if (g_str_equal(pad, "depth")) {
        state.depth = info;
        gst_caps_replace(&state.depth_caps, caps);
    } else if (g_str_equal(pad, "uncertainty")) {
        state.uncertainty = info;
    } else {
        state.colour = info;
        gst_pad_mark_reconfigure(GST_AGGREGATOR_SRC_PAD(self));
    }
    return true;
}

static gboolean sink_event(GstAggregator *aggregator, GstAggregatorPad *pad, GstEvent *event)
{
    auto *self = GST_DEPTH_FILE_ENC(aggregator);
    if (dff::is_gap_out_of_time(event, pad->segment)) {
        gst_event_unref(event);
        return TRUE;
    }
    if (GST_EVENT_TYPE(event) == GST_EVENT_CAPS) {
        GstCaps *caps = nullptr;
        gst_event_parse_caps(event, &caps);
        GST_INFO_OBJECT(pad, "caps %" GST_PTR_FORMAT, caps);
        const bool accepted = set_caps(self, GST_PAD_NAME(pad), caps);
        gst_event_unref(event);
        return accepted;
    }
    if (GST_EVENT_TYPE(event) == GST_EVENT_SEGMENT && g_str_equal(GST_PAD_NAME(pad), "color")) {
        const GstSegment *segment = nullptr;
        gst_event_parse_segment(event, &segment);
        if (segment->format == GST_FORMAT_TIME)
            gst_aggregator_update_segment(aggregator, segment);
    }
    return GST_AGGREGATOR_CLASS(gst_depth_file_enc_parent_class)->sink_event(aggregator, pad, event);
}

static gboolean src_event(GstAggregator *aggregator, GstEvent *event)
{
    if (!dff::is_refused_seek(GST_ELEMENT(aggregator), event))
        return GST_AGGREGATOR_CLASS(gst_depth_file_enc_parent_class)->src_event(aggregator, event);
    gst_event_unref(event);
    return FALSE;
}

/* What nothing behind takes is told here: the pads' threads would learn it by their next buffer, and the last
 * pictures of a stream have none after them. */
static GstFlowReturn update_src_caps(GstAggregator *aggregator, GstCaps *downstream, GstCaps **caps)
{
    const State &state = state_of(GST_DEPTH_FILE_ENC(aggregator));
    if (!state.colour)
        return GST_AGGREGATOR_FLOW_NEED_DATA;
    g_autoptr(GstCaps) template_caps = gst_pad_get_pad_template_caps(GST_AGGREGATOR_SRC_PAD(aggregator));
    *caps = gst_caps_copy(template_caps);
    gst_caps_set_simple(*caps, "width", G_TYPE_INT, GST_VIDEO_INFO_WIDTH(&*state.colour), "height",
                        G_TYPE_INT, GST_VIDEO_INFO_HEIGHT(&*state.colour), "framerate", GST_TYPE_FRACTION,
                        GST_VIDEO_INFO_FPS_N(&*state.colour), GST_VIDEO_INFO_FPS_D(&*state.colour), nullptr);
    if (!downstream || gst_caps_can_intersect(*caps, downstream))
        return GST_FLOW_OK;
    GST_ELEMENT_ERROR(aggregator, CORE, NEGOTIATION,
                      ("The files are of pictures of %s pixels, and what comes after does not take them: "
                       "scale the pictures and their depth before this element",
                       size_text(*state.colour).c_str()),
                      ("%" GST_PTR_FORMAT " is none of %" GST_PTR_FORMAT, *caps, downstream));
    return GST_FLOW_ERROR;
}

/* Without an answer, a tee before this element could not use a pool. */
static gboolean propose_allocation(GstAggregator *, GstAggregatorPad *, GstQuery *, GstQuery *query)
{
    gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
    return TRUE;
}

static gboolean start(GstAggregator *aggregator)
{
    auto *self = GST_DEPTH_FILE_ENC(aggregator);
    for (const char *name : {"color", "depth"})
        if (!gst_pad_is_linked(GST_PAD(find_pad(self, name).get()))) {
            GST_ELEMENT_ERROR(self, CORE, PAD,
                              ("The pad \"%s\" is not linked: %s needs a picture and its depth", name,
                               GST_OBJECT_NAME(gst_element_get_factory(GST_ELEMENT(self)))),
                              (nullptr));
            return FALSE;
        }
    return TRUE;
}

static gboolean stop(GstAggregator *aggregator)
{
    State &state = state_of(GST_DEPTH_FILE_ENC(aggregator));
    state.colour.reset();
    state.depth.reset();
    state.uncertainty.reset();
    state.stack.reset();
    gst_clear_caps(&state.depth_caps);
    return TRUE;
}

static GstAggregatorPad *create_new_pad(GstAggregator *aggregator, GstPadTemplate *templ, const gchar *,
                                        const GstCaps *)
{
    g_autoptr(GstPad) taken = gst_element_get_static_pad(GST_ELEMENT(aggregator), templ->name_template);
    if (taken) {
        GST_WARNING_OBJECT(aggregator, "The pad %s is in use already", templ->name_template);
        return nullptr;
    }
    return GST_AGGREGATOR_PAD(g_object_new(GST_TYPE_AGGREGATOR_PAD, "name", templ->name_template, "direction",
                                           GST_PAD_SINK, "template", templ, nullptr));
}

static void finalize(GObject *object)
{
    delete &state_of(GST_DEPTH_FILE_ENC(object));
    G_OBJECT_CLASS(gst_depth_file_enc_parent_class)->finalize(object);
}

/* Always pads, built here so that they keep their names. */
static void add_sink(GstDepthFileEnc *self, GstStaticPadTemplate *static_template)
{
    g_autoptr(GstPadTemplate) pad_template = gst_static_pad_template_get(static_template);
    gst_element_add_pad(GST_ELEMENT(self),
                        GST_PAD(g_object_new(GST_TYPE_AGGREGATOR_PAD, "name", static_template->name_template,
                                             "direction", GST_PAD_SINK, "template", pad_template, nullptr)));
}

static void gst_depth_file_enc_init(GstDepthFileEnc *self)
{
    static_cast<GstDepthFileEncPrivate *>(gst_depth_file_enc_get_instance_private(self))->state = new State;
    add_sink(self, &colour_template);
    add_sink(self, &depth_template);
}

static void gst_depth_file_enc_class_init(GstDepthFileEncClass *klass)
{
    auto *aggregator_class = GST_AGGREGATOR_CLASS(klass);

    GST_DEBUG_CATEGORY_INIT(dff_file_encoder_debug, "depthfileenc", 0, "files of colour and depth");
    G_OBJECT_CLASS(klass)->finalize = finalize;
    aggregator_class->aggregate = aggregate;
    aggregator_class->sink_event = sink_event;
    aggregator_class->src_event = src_event;
    aggregator_class->update_src_caps = update_src_caps;
    aggregator_class->propose_allocation = propose_allocation;
    aggregator_class->create_new_pad = create_new_pad;
    aggregator_class->start = start;
    aggregator_class->stop = stop;
    for (GstStaticPadTemplate *pad_template : {&colour_template, &depth_template, &uncertainty_template})
        gst_element_class_add_static_pad_template_with_gtype(GST_ELEMENT_CLASS(klass), pad_template,
                                                             GST_TYPE_AGGREGATOR_PAD);
    gst_type_mark_as_plugin_api(GST_TYPE_DEPTH_FILE_ENC, static_cast<GstPluginAPIFlags>(0));
}
