/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

namespace dff {

/* Whether the event is a seek that every source before the element says it cannot follow, as no camera can.
 * GstAggregator stops before it passes a seek on, and never goes on where nobody takes it: so it must not see
 * such a one. Takes no reference. */
inline bool is_refused_seek(GstElement *element, GstEvent *event)
{
    if (GST_EVENT_TYPE(event) != GST_EVENT_SEEK)
        return false;
    bool is_refused = true;
    const auto ask = [](GstElement *, GstPad *pad, gpointer refused) -> gboolean {
        g_autoptr(GstQuery) query = gst_query_new_seeking(GST_FORMAT_TIME);
        gboolean seekable = TRUE; /* where nobody answers */
        if (gst_pad_peer_query(pad, query))
            gst_query_parse_seeking(query, nullptr, &seekable, nullptr, nullptr);
        if (seekable)
            *static_cast<bool *>(refused) = false;
        return !seekable;
    };
    gst_element_foreach_sink_pad(element, ask, &is_refused);
    return is_refused;
}

} // namespace dff
