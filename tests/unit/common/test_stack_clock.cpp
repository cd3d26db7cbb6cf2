/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "common/stack_clock.h"

#include <gtest/gtest.h>

using namespace dff;

namespace {

GstVideoInfo at_rate(int n, int d)
{
    GstVideoInfo frame;
    gst_video_info_set_format(&frame, GST_VIDEO_FORMAT_GRAY8, 64, 64);
    frame.fps_n = n;
    frame.fps_d = d;
    return frame;
}

GstSegment segment_in(GstFormat format, guint64 start)
{
    GstSegment segment;
    gst_segment_init(&segment, format);
    segment.start = start;
    return segment;
}

constexpr GstClockTime none = GST_CLOCK_TIME_NONE;

} // namespace

TEST(StackClock, each_segment_begins_anew)
{
    const GstVideoInfo frame = at_rate(3, 1);
    StackClock clock;
    for (unsigned pass = 0; pass < 2; pass++) {
        const GstSegment segment = clock.begin(segment_in(GST_FORMAT_BYTES, 1000));
        EXPECT_EQ(segment.format, GST_FORMAT_TIME);
        EXPECT_EQ(segment.start, 0u);
        EXPECT_EQ(clock.next(frame, none, none).start, 0u);
        const StackClock::Time second = clock.next(frame, none, none);
        EXPECT_EQ(second.start, GST_SECOND / 3);
        EXPECT_EQ(second.start + second.duration, 2 * GST_SECOND / 3);
    }
}

TEST(StackClock, times_that_are_known_stay_and_are_counted)
{
    const GstVideoInfo frame = at_rate(10, 1);
    StackClock clock;
    clock.begin(segment_in(GST_FORMAT_TIME, 0));
    EXPECT_EQ(clock.next(frame, 5, 7).duration, 7u);
    EXPECT_EQ(clock.next(frame, 5, none).duration, GST_SECOND / 10);
    EXPECT_EQ(clock.next(frame, none, none).start, 2 * GST_SECOND / 10);
}

TEST(StackClock, a_segment_in_time_is_counted_from_its_start)
{
    StackClock clock;
    const GstSegment segment = clock.begin(segment_in(GST_FORMAT_TIME, 4 * GST_SECOND));
    EXPECT_EQ(segment.start, 4 * GST_SECOND);
    EXPECT_EQ(clock.next(at_rate(10, 1), none, none).start, 4 * GST_SECOND);
}

TEST(StackClock, without_a_rate_nothing_is_made_up)
{
    StackClock clock;
    const StackClock::Time time = clock.next(at_rate(0, 1), none, none);
    EXPECT_FALSE(GST_CLOCK_TIME_IS_VALID(time.start));
    EXPECT_FALSE(GST_CLOCK_TIME_IS_VALID(time.duration));
}
