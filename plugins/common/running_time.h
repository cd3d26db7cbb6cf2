/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

namespace dff {

/* The running time of a time on a stream; GST_CLOCK_TIME_NONE where the segment does not count in time, as
 * that of a file does not, of which GStreamer's function takes the question for a fault. */
inline GstClockTime running_time(const GstSegment &segment, GstClockTime time)
{
    return segment.format == GST_FORMAT_TIME ? gst_segment_to_running_time(&segment, GST_FORMAT_TIME, time)
                                             : GST_CLOCK_TIME_NONE;
}

/* Whether an event is a GAP before the first segment that counts in time, as a source sends whose caps were
 * refused. GStreamer's aggregators take it for a fault of the program. */
inline bool is_gap_out_of_time(GstEvent *event, const GstSegment &segment)
{
    return GST_EVENT_TYPE(event) == GST_EVENT_GAP && segment.format != GST_FORMAT_TIME;
}

} // namespace dff
