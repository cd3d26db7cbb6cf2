/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/matched_inputs.h"

#include <algorithm>

namespace dff {

namespace {

constexpr GstClockTime tolerance = GST_MSECOND; /* of containers that round */

} // namespace

Match match_inputs(std::span<GstAggregatorPad *const> pads)
{
    GstClockTime latest = 0;
    for (GstAggregatorPad *pad : pads) {
        g_autoptr(GstBuffer) buffer = gst_aggregator_pad_peek_buffer(pad);
        if (!buffer)
            return gst_aggregator_pad_is_eos(pad) ? Match::Ended : Match::Waiting;
        if (gst_buffer_get_size(buffer) == 0) { /* a gap */
            gst_aggregator_pad_drop_buffer(pad);
            return Match::Again;
        }
        if (GST_BUFFER_PTS_IS_VALID(buffer))
            latest = std::max(latest, GST_BUFFER_PTS(buffer));
    }
    bool dropped = false;
    for (GstAggregatorPad *pad : pads) {
        g_autoptr(GstBuffer) buffer = gst_aggregator_pad_peek_buffer(pad);
        if (GST_BUFFER_PTS_IS_VALID(buffer) && GST_BUFFER_PTS(buffer) + tolerance < latest)
            dropped |= gst_aggregator_pad_drop_buffer(pad) != FALSE;
    }
    return dropped ? Match::Again : Match::Ready;
}

} // namespace dff
