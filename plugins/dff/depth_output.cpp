/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depth_output.h"

#include "common/stream_start.h"

GST_DEBUG_CATEGORY_EXTERN(dff_depth_debug);
#define GST_CAT_DEFAULT dff_depth_debug

namespace dff {

DepthOutput::DepthOutput(GstElement *element, GstPad *pad, GstVideoFormat format)
    : element_(element), pad_(GST_PAD(gst_object_ref(pad))), format_(format)
{
}

DepthOutput::~DepthOutput()
{
    gst_clear_caps(&caps_);
    gst_object_unref(pad_);
}

void DepthOutput::open()
{
    if (opened_)
        return;
    opened_ = true;
    g_autofree gchar *name = gst_pad_get_name(pad_);
    g_autofree gchar *stream_id = gst_pad_create_stream_id(pad_, element_, name);
    g_autoptr(GstEvent) upstream = nullptr;
    g_autoptr(GstPad) sink = gst_element_get_static_pad(element_, "sink");
    guint group = 0;

    GstEvent *event = gst_event_new_stream_start(stream_id);
    upstream = gst_pad_get_sticky_event(sink, GST_EVENT_STREAM_START, 0);
    if (upstream && gst_event_parse_group_id(upstream, &group))
        gst_event_set_group_id(event, group);
    push_stream_start(pad_, event);
}

void DepthOutput::restart()
{
    opened_ = false;
    has_segment_ = false;
    gst_clear_caps(&caps_);
}

void DepthOutput::prepare(const GstVideoInfo &stack, const GstDepthInfo &depth, const StreamSegment &segment)
{
    open();

    GstVideoInfo info;
    gst_video_info_set_format(&info, format_, GST_VIDEO_INFO_WIDTH(&stack), GST_VIDEO_INFO_HEIGHT(&stack));
    GST_VIDEO_INFO_FPS_N(&info) = GST_VIDEO_INFO_FPS_N(&stack);
    GST_VIDEO_INFO_FPS_D(&info) = GST_VIDEO_INFO_FPS_D(&stack);
    g_autoptr(GstCaps) caps = gst_video_info_to_caps(&info);
    if (has_depth())
        gst_depth_info_to_caps(&depth, caps);

    if (!caps_ || !gst_caps_is_equal(caps, caps_)) {
        GST_INFO_OBJECT(pad_, "maps are %" GST_PTR_FORMAT, caps);
        gst_caps_replace(&caps_, caps);
        gst_pad_push_event(pad_, gst_event_new_caps(caps));
        pool_.start(info);
    }
    send_segment(segment);
}

void DepthOutput::end(const StreamSegment &segment)
{
    open();
    if (segment.seqnum != GST_SEQNUM_INVALID)
        send_segment(segment);
}

void DepthOutput::pass_gap(GstEvent *gap, const StreamSegment &segment)
{
    if (!caps_)
        return;
    send_segment(segment);
    gst_pad_push_event(pad_, gst_event_ref(gap));
}

void DepthOutput::send_segment(const StreamSegment &segment)
{
    if (has_segment_ && segment_.seqnum == segment.seqnum &&
        gst_segment_is_equal(&segment_.segment, &segment.segment))
        return;
    segment_ = segment;
    has_segment_ = true;
    GstEvent *event = gst_event_new_segment(&segment.segment);
    gst_event_set_seqnum(event, segment.seqnum);
    gst_pad_push_event(pad_, event);
}

} // namespace dff
