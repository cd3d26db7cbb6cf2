/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "stream_pad.h"

void begin_stream(GstElement *element, GstPad *pad, const gchar *name, guint group)
{
    g_autoptr(GstEvent) begun = gst_pad_get_sticky_event(pad, GST_EVENT_STREAM_START, 0);
    if (begun)
        return;
    g_autofree gchar *id = gst_pad_create_stream_id(pad, element, name);
    GstEvent *event = gst_event_new_stream_start(id);
    gst_event_set_group_id(event, group);
    gst_pad_push_event(pad, event);
}

void begin_segment(GstPad *pad)
{
    g_autoptr(GstEvent) begun = gst_pad_get_sticky_event(pad, GST_EVENT_SEGMENT, 0);
    if (begun)
        return;
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_pad_push_event(pad, gst_event_new_segment(&segment));
}

bool change_caps(GstPad *pad, GstCaps *caps)
{
    g_autoptr(GstCaps) current = gst_pad_get_current_caps(pad);
    return (current && gst_caps_is_equal(current, caps)) || gst_pad_set_caps(pad, caps);
}

bool caps_are_taken(GstPad *pad)
{
    g_autoptr(GstCaps) sent = gst_pad_get_current_caps(pad);
    return !sent || gst_pad_peer_query_accept_caps(pad, sent);
}

guint group_of(GstPad *pad)
{
    guint group = GST_GROUP_ID_INVALID;
    g_autoptr(GstEvent) event = gst_pad_get_sticky_event(pad, GST_EVENT_STREAM_START, 0);
    if (event)
        gst_event_parse_group_id(event, &group);
    return group;
}
