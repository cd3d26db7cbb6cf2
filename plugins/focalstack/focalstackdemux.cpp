/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-focalstackdemux
 *
 * Takes focal stacks apart into their frames, nearest plane first, each with its #GstFocusMeta: the inverse
 * of focalstackmux. The frames share the stack's memory, nothing is copied, and their times are spread evenly
 * over the stack's duration. A plane that was missing in its sweep, and so shows a picture from elsewhere, is
 * sent with the flag CORRUPTED.
 *
 * A stack without metas is taken as frames one after the other in the format's default layout; without a
 * time, the k-th stack is at k / framerate.
 *
 * ## Example pipeline
 * |[
 * gst-launch-1.0 videotestsrc num-buffers=4 ! m.sink_0  videotestsrc num-buffers=4 pattern=ball ! m.sink_1 \
 *     focalstackmux name=m ! focalstackdemux ! videoconvert ! pngenc ! multifilesink location=plane-%d.png
 * ]| writes eight pictures, from the two planes in turn.
 */
#include "focalstack/focalstackdemux.h"

#include "focalstack/stack_caps.h"
#include "focalstack/stack_splitter.h"

GST_DEBUG_CATEGORY_STATIC(focalstackdemux_debug);
#define GST_CAT_DEFAULT focalstackdemux_debug

namespace {

/* What the demux knows between two stacks. Guarded by the sink pad's stream lock. */
struct FocalStackDemuxState {
    dff::StackSplitter splitter;
    bool has_caps = false;
};

GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_FOCAL_STACK_CAPS_MAKE));
GstStaticPadTemplate source_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(FOCAL_STACK_FRAME_CAPS));

} // namespace

struct _GstFocalStackDemux {
    GstElement parent;
    GstPad *sink;
    GstPad *source;
    FocalStackDemuxState *state;
};

G_DEFINE_FINAL_TYPE(GstFocalStackDemux, gst_focal_stack_demux, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(focalstackdemux, "focalstackdemux", GST_RANK_NONE, GST_TYPE_FOCAL_STACK_DEMUX)

namespace {

GstFlowReturn send_frame(GstFocalStackDemux *self, GstBuffer *stack, unsigned plane)
{
    g_autoptr(GError) error = nullptr;
    dff::BufferPtr frame = self->state->splitter.frame(plane, &error);
    if (!frame) {
        GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("%s.", error->message),
                          ("Check format, width, height and planes of the caps."));
        return GST_FLOW_ERROR;
    }
    if (plane == 0 && GST_BUFFER_IS_DISCONT(stack))
        GST_BUFFER_FLAG_SET(frame.get(), GST_BUFFER_FLAG_DISCONT);
    if (plane == 0)
        dff::copy_reference_times(stack, frame.get());
    return gst_pad_push(self->source, frame.release());
}

GstFlowReturn chain(GstPad *, GstObject *parent, GstBuffer *buffer)
{
    GstFocalStackDemux *self = GST_FOCAL_STACK_DEMUX(parent);
    const dff::BufferPtr stack(buffer);
    if (!self->state->has_caps)
        return GST_FLOW_NOT_NEGOTIATED;

    GST_LOG_OBJECT(self, "taking apart %" GST_PTR_FORMAT, stack.get());
    g_autoptr(GError) doubt = nullptr;
    gst_focal_stack_info_get_meta(&self->state->splitter.shape(), stack.get(), &doubt);
    if (doubt)
        GST_WARNING_OBJECT(self, "%s: the frames' labels are counted instead", doubt->message);
    self->state->splitter.begin(stack.get());
    GstFlowReturn flow = GST_FLOW_OK;
    for (unsigned z = 0; z < self->state->splitter.shape().planes && flow == GST_FLOW_OK; z++)
        flow = send_frame(self, stack.get(), z);
    return flow;
}

gboolean take_caps(GstFocalStackDemux *self, GstEvent *event)
{
    GstCaps *caps = nullptr;
    GstFocalStackInfo shape;
    gst_event_parse_caps(event, &caps);
    self->state->has_caps = gst_focal_stack_info_from_caps(&shape, caps);
    gst_event_unref(event);
    if (!self->state->has_caps)
        return FALSE;

    self->state->splitter.set_shape(shape);
    const GstVideoInfo frame = self->state->splitter.frame_info();
    g_autoptr(GstCaps) frame_caps = gst_video_info_to_caps(&frame);
    GST_INFO_OBJECT(self, "frames are %" GST_PTR_FORMAT, frame_caps);
    return gst_pad_push_event(self->source, gst_event_new_caps(frame_caps));
}

gboolean take_segment(GstFocalStackDemux *self, GstEvent *event)
{
    const GstSegment *segment = nullptr;
    gst_event_parse_segment(event, &segment);
    const GstSegment time = self->state->splitter.begin_segment(*segment);
    if (segment->format == GST_FORMAT_TIME)
        return gst_pad_push_event(self->source, event);

    GstEvent *replacement = gst_event_new_segment(&time);
    gst_event_set_seqnum(replacement, gst_event_get_seqnum(event));
    gst_event_unref(event);
    return gst_pad_push_event(self->source, replacement);
}

gboolean sink_event(GstPad *pad, GstObject *parent, GstEvent *event)
{
    GstFocalStackDemux *self = GST_FOCAL_STACK_DEMUX(parent);
    switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_CAPS:
        return take_caps(self, event);
    case GST_EVENT_SEGMENT:
        return take_segment(self, event);
    case GST_EVENT_STREAM_START:
    case GST_EVENT_FLUSH_STOP:
        self->state->splitter.restart();
        break;
    default:
        break;
    }
    return gst_pad_event_default(pad, parent, event);
}

gboolean sink_query(GstPad *pad, GstObject *parent, GstQuery *query)
{
    switch (GST_QUERY_TYPE(query)) {
    case GST_QUERY_CAPS:
        dff::answer_caps_query(query, pad, GST_FOCAL_STACK_DEMUX(parent)->source,
                               dff::stack_caps_from_frame_caps, dff::Sizes::AsTheyAre);
        return TRUE;
    case GST_QUERY_ALLOCATION:
        gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
        return TRUE;
    default:
        return gst_pad_query_default(pad, parent, query);
    }
}

void finalize(GObject *object)
{
    delete GST_FOCAL_STACK_DEMUX(object)->state;
    G_OBJECT_CLASS(gst_focal_stack_demux_parent_class)->finalize(object);
}

} // namespace

static void gst_focal_stack_demux_class_init(GstFocalStackDemuxClass *klass)
{
    GstElementClass *element_class = GST_ELEMENT_CLASS(klass);
    GST_DEBUG_CATEGORY_INIT(focalstackdemux_debug, "focalstackdemux", 0, "focal stacks to frames");

    G_OBJECT_CLASS(klass)->finalize = finalize;
    gst_element_class_add_static_pad_template(element_class, &sink_template);
    gst_element_class_add_static_pad_template(element_class, &source_template);
    gst_element_class_set_static_metadata(element_class, "Focal stack demuxer", "Demuxer/Video",
                                          "Takes focal stacks apart into their frames",
                                          "gst-plugins-dff authors");
}

static void gst_focal_stack_demux_init(GstFocalStackDemux *self)
{
    self->state = new FocalStackDemuxState;
    self->source = gst_pad_new_from_static_template(&source_template, "src");
    gst_element_add_pad(GST_ELEMENT(self), self->source);

    self->sink = gst_pad_new_from_static_template(&sink_template, "sink");
    gst_pad_set_chain_function(self->sink, chain);
    gst_pad_set_event_function(self->sink, sink_event);
    gst_pad_set_query_function(self->sink, sink_query);
    gst_element_add_pad(GST_ELEMENT(self), self->sink);
}
