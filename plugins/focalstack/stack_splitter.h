/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "common/stack_clock.h"
#include "focalstack/partial_stack.h"

#include <cstdint>

namespace dff {

/* Takes stacks apart. The frames share the stacks' memory. */
class StackSplitter {
public:
    void set_shape(const GstFocalStackInfo &shape);
    const GstFocalStackInfo &shape() const { return shape_; }

    /* Rate, format and size of the frames. */
    GstVideoInfo frame_info() const;

    /* Count the stacks from 0 again, whose number is their sweep's where they have no meta. */
    void restart() { stacks_ = 0; }

    /* StackClock::begin() */
    GstSegment begin_segment(const GstSegment &segment) { return clock_.begin(segment); }

    /* Begins with the next stack, which stays the caller's as long as frames are taken from it. */
    void begin(GstBuffer *stack);

    /* The frame of a plane, or nothing and the error where the stack does not fit its caps. */
    BufferPtr frame(unsigned plane, GError **error) const;

private:
    void set_time(GstBuffer *frame, unsigned plane) const;
    void add_focus(GstBuffer *frame, unsigned plane) const;

    GstFocalStackInfo shape_{};
    GstBuffer *stack_ = nullptr;
    StackClock clock_;
    StackClock::Time time_{GST_CLOCK_TIME_NONE, GST_CLOCK_TIME_NONE};
    uint64_t number_ = 0;
    uint64_t stacks_ = 0;
};

} // namespace dff
