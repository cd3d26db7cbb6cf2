/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "common/stack_clock.h"
#include "focalstack/stack_maker.h"

#include <gst/gst.h>

namespace dff {

/* The mux's source pad: sends caps, segment and stacks in their order, and tells the application of what was
 * lost. Guarded by the mux's stream lock. */
class MuxOutput {
public:
    MuxOutput(GstElement *element, GstPad *source) : element_(element), source_(source) {}

    /* The stream begins anew: caps and segment are due before the next stack. */
    void restart();

    /* Downstream was flushed, and the same stream goes on. */
    void resume();

    /* Begins as the only input did, by its event, which is taken over; or, where the pads have no common
     * stream, with one of the mux's own. */
    void begin_stream(GstEvent *stream_start);
    void begin_own_stream();

    /* A flush; taken over. */
    bool push_event(GstEvent *event) { return gst_pad_push_event(source_, event); }

    /* `seqnum` is that of its event. */
    void set_segment(const GstSegment &segment, guint32 seqnum);
    const GstSegment &segment() const { return segment_; }

    /* Whether downstream takes stacks of this shape. */
    bool set_shape(const GstFocalStackInfo &info);

    /* Sends the stack, or tells of the loss. */
    GstFlowReturn send(Outcome outcome, const MuxStatistics &statistics);

    /* A stream that ends without a stack has a segment too: aggregators downstream number their end by it. */
    void end(GstEvent *eos);

    /* Goes downstream as soon as downstream can understand it; lost where nothing was sent yet. */
    bool send_gap(GstEvent *gap);

private:
    void send_due_segment();
    void post_loss(const TimeSpan &time, const MuxStatistics &statistics);

    GstElement *element_;
    GstPad *source_;
    GstFocalStackInfo info_{};
    GstSegment segment_{};
    StackClock clock_;
    guint32 seqnum_ = GST_SEQNUM_INVALID; /* of its event */
    bool has_caps_ = false;
    bool segment_due_ = true;
    bool discont_ = true;
};

} // namespace dff
