/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/mux_output.h"

#include "common/stream_start.h"

GST_DEBUG_CATEGORY_EXTERN(focalstackmux_debug);
#define GST_CAT_DEFAULT focalstackmux_debug

namespace dff {

void MuxOutput::restart()
{
    gst_segment_init(&segment_, GST_FORMAT_TIME);
    clock_ = {};
    seqnum_ = GST_SEQNUM_INVALID;
    has_caps_ = false;
    segment_due_ = true;
    discont_ = true;
}

void MuxOutput::resume()
{
    segment_due_ = true;
    discont_ = true;
}

void MuxOutput::begin_stream(GstEvent *stream_start)
{
    push_stream_start(source_, stream_start);
    segment_due_ = true;
}

void MuxOutput::begin_own_stream()
{
    g_autofree gchar *id = g_strdup_printf("%s-%08x", GST_ELEMENT_NAME(element_), g_random_int());
    begin_stream(gst_event_new_stream_start(id));
}

void MuxOutput::set_segment(const GstSegment &segment, guint32 seqnum)
{
    segment_ = clock_.begin(segment);
    seqnum_ = seqnum;
    segment_due_ = true;
    discont_ = true;
}

bool MuxOutput::set_shape(const GstFocalStackInfo &info)
{
    g_autoptr(GstCaps) caps = gst_focal_stack_info_to_caps(&info);
    GST_INFO_OBJECT(element_, "stacks are %" GST_PTR_FORMAT, caps);
    info_ = info;
    has_caps_ = gst_pad_push_event(source_, gst_event_new_caps(caps));
    return has_caps_;
}

void MuxOutput::send_due_segment()
{
    if (!segment_due_)
        return;
    GstEvent *event = gst_event_new_segment(&segment_);
    if (seqnum_ != GST_SEQNUM_INVALID)
        gst_event_set_seqnum(event, seqnum_);
    gst_pad_push_event(source_, event);
    segment_due_ = false;
}

void MuxOutput::end(GstEvent *eos)
{
    send_due_segment();
    gst_pad_push_event(source_, eos);
}

GstFlowReturn MuxOutput::send(Outcome outcome, const MuxStatistics &statistics)
{
    if (!outcome.stack) {
        GST_DEBUG_OBJECT(element_,
                         "a stack or frame of %" GST_TIME_FORMAT " is lost; dropped %" G_GUINT64_FORMAT
                         ", repeated %" G_GUINT64_FORMAT ", late %" G_GUINT64_FORMAT,
                         GST_TIME_ARGS(outcome.time.start), statistics.dropped, statistics.repeated,
                         statistics.late);
        discont_ = true;
        post_loss(outcome.time, statistics);
        return GST_FLOW_OK;
    }
    clock_.stamp(outcome.stack.get(), info_.frame);
    if (discont_)
        GST_BUFFER_FLAG_SET(outcome.stack.get(), GST_BUFFER_FLAG_DISCONT);
    discont_ = false;
    const GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(outcome.stack.get());
    GST_DEBUG_OBJECT(element_,
                     "stack %" G_GUINT64_FORMAT " of %" GST_TIME_FORMAT
                     ", planes filled in: %#" G_GINT64_MODIFIER "x",
                     meta->sequence, GST_TIME_ARGS(GST_BUFFER_PTS(outcome.stack.get())), meta->missing);
    send_due_segment();
    return gst_pad_push(source_, outcome.stack.release());
}

bool MuxOutput::send_gap(GstEvent *gap)
{
    if (!has_caps_) {
        gst_event_unref(gap);
        return true;
    }
    send_due_segment();
    return gst_pad_push_event(source_, gap);
}

void MuxOutput::post_loss(const TimeSpan &time, const MuxStatistics &statistics)
{
    const guint64 running_time = gst_segment_to_running_time(&segment_, GST_FORMAT_TIME, time.start);
    const guint64 stream_time = gst_segment_to_stream_time(&segment_, GST_FORMAT_TIME, time.start);
    GstMessage *message = gst_message_new_qos(GST_OBJECT(element_), FALSE, running_time, stream_time,
                                              time.start, time.duration);
    gst_message_set_qos_stats(message, GST_FORMAT_BUFFERS, statistics.stacks, statistics.dropped);
    gst_element_post_message(element_, message);
}

} // namespace dff
