/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depth_matching.h"

#include "common/running_time.h"

namespace dff {

namespace {

/* How much later than the colour picture the depth map is; 0 where either has no time. */
GstClockTimeDiff lateness(GstAggregatorPad *color_pad, GstBuffer *color, GstAggregatorPad *depth_pad,
                          GstBuffer *depth)
{
    const GstClockTime color_time = running_time(color_pad->segment, GST_BUFFER_PTS(color));
    const GstClockTime depth_time = running_time(depth_pad->segment, GST_BUFFER_PTS(depth));
    if (!GST_CLOCK_TIME_IS_VALID(color_time) || !GST_CLOCK_TIME_IS_VALID(depth_time))
        return 0;
    return GST_CLOCK_DIFF(color_time, depth_time);
}

} // namespace

std::optional<GstBuffer *> matching_depth(GstAggregatorPad *color_pad, GstBuffer *color,
                                          GstAggregatorPad *depth_pad)
{
    const GstClockTime duration = GST_BUFFER_DURATION(color);
    const GstClockTimeDiff tolerance =
        GST_CLOCK_TIME_IS_VALID(duration) ? static_cast<GstClockTimeDiff>(duration / 2) : GST_MSECOND;

    while (GstBuffer *depth = gst_aggregator_pad_peek_buffer(depth_pad)) {
        const bool is_gap = gst_buffer_get_size(depth) == 0;
        const GstClockTimeDiff late = lateness(color_pad, color, depth_pad, depth);
        if (late > tolerance) {
            gst_buffer_unref(depth);
            return nullptr;
        }
        gst_aggregator_pad_drop_buffer(depth_pad);
        if (!is_gap && late >= -tolerance)
            return depth;
        /* A map without its picture, or a gap. */
        gst_buffer_unref(depth);
        if (is_gap && late >= -tolerance)
            return nullptr;
    }
    if (gst_aggregator_pad_is_eos(depth_pad))
        return nullptr;
    return std::nullopt;
}

} // namespace dff
