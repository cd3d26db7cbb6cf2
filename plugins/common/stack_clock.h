/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/video/video.h>

namespace dff {

/* The one clock of stacks that come without times, as those of a file do: the k-th of a segment lies k
 * periods after its start, at the caps' rate. Each stack is counted, whether or not it has a time. */
class StackClock {
public:
    struct Time {
        GstClockTime start;
        GstClockTime duration;
    };

    /* A segment begins. Returns the one for the stacks' times: `segment` if that counts in time, else one
     * from 0 on. */
    GstSegment begin(const GstSegment &segment)
    {
        GstSegment time = segment;
        if (segment.format != GST_FORMAT_TIME)
            gst_segment_init(&time, GST_FORMAT_TIME);
        stacks_ = 0;
        start_ = time.start;
        return time;
    }

    /* The time of the next stack, of which `start` and `duration` may be known already. Where the caps have
     * no rate, nothing is made up. */
    Time next(const GstVideoInfo &frame, GstClockTime start, GstClockTime duration)
    {
        const guint64 k = stacks_++;
        if (GST_VIDEO_INFO_FPS_N(&frame) <= 0 || GST_VIDEO_INFO_FPS_D(&frame) <= 0)
            return {start, duration};
        if (GST_CLOCK_TIME_IS_VALID(start))
            return {start, GST_CLOCK_TIME_IS_VALID(duration) ? duration : time_of(1, frame)};
        return {start_ + time_of(k, frame), time_of(k + 1, frame) - time_of(k, frame)};
    }

    /* next(), written to the stack. */
    void stamp(GstBuffer *stack, const GstVideoInfo &frame)
    {
        const Time time = next(frame, GST_BUFFER_PTS(stack), GST_BUFFER_DURATION(stack));
        GST_BUFFER_PTS(stack) = time.start;
        GST_BUFFER_DURATION(stack) = time.duration;
    }

private:
    static GstClockTime time_of(guint64 stacks, const GstVideoInfo &frame)
    {
        return gst_util_uint64_scale(stacks, GST_SECOND * static_cast<guint64>(GST_VIDEO_INFO_FPS_D(&frame)),
                                     static_cast<guint64>(GST_VIDEO_INFO_FPS_N(&frame)));
    }

    guint64 stacks_ = 0; /* of this segment */
    GstClockTime start_ = 0;
};

} // namespace dff
