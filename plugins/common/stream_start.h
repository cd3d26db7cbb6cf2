/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

namespace dff {

/* Pushes a stream-start, taken over. A stream that ended before anybody knew its caps had a segment all the
 * same, since aggregators downstream number their end by it. When the pad then begins anew, caps would come
 * behind that segment, which GStreamer warns of, and only a flush takes it back. It loses nothing: no buffer
 * was sent. Running time goes on. */
inline bool push_stream_start(GstPad *source, GstEvent *stream_start)
{
    g_autoptr(GstEvent) segment = gst_pad_get_sticky_event(source, GST_EVENT_SEGMENT, 0);
    if (segment && !gst_pad_has_current_caps(source)) {
        GstEvent *start = gst_event_new_flush_start();
        GstEvent *stop = gst_event_new_flush_stop(FALSE);
        gst_event_set_seqnum(stop, gst_event_get_seqnum(start));
        gst_pad_push_event(source, start);
        gst_pad_push_event(source, stop);
    }
    return gst_pad_push_event(source, stream_start);
}

} // namespace dff
