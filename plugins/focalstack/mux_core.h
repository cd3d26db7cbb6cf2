/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/mux_inputs.h"
#include "focalstack/mux_output.h"
#include "focalstack/stack_maker.h"
#include "focalstack/sweep_gate.h"

#include <gst/gst.h>

#include <memory>
#include <mutex>
#include <optional>

namespace dff {

struct MuxSettings {
    unsigned planes = 0; /* 0: as the frames or the pads say */
    OnMissing on_missing = OnMissing::Drop;
    StackWindow window = StackWindow::Sweep;
};

/* The mux behind its pads. */
class MuxCore {
public:
    MuxCore(GstElement *element, GstPad *source) : element_(element), output_(element, source) {}

    /* Any thread. */
    MuxInput &add_input(GstPad *pad, std::optional<unsigned> plane);
    void close_input(MuxInput &input);
    void remove_input(GstPad *pad) { inputs_.remove(pad); }
    MuxStatistics statistics() const;
    GstClockTime latency() const;

    /* Around the streaming. start() returns false, with the error posted, if the pads make no sense. */
    bool start(const MuxSettings &settings);
    void stop();

    /* The input's streaming thread. A closed input's take() returns at once. */
    GstFlowReturn take(MuxInput &input, GstBuffer *buffer);
    bool set_caps(MuxInput &input, const GstCaps *caps);
    void set_segment(MuxInput &input, const GstSegment &segment, guint32 seqnum);
    bool pass_gap(MuxInput &input, GstEvent *gap);
    void begin(MuxInput &input);
    /* True if this was the last input's end, so that the whole stream ends. */
    bool end(MuxInput &input);

    /* Wakes who waits for others; nobody waits until start(). */
    void unblock() { gate_.shut(); }

    /* Around a flush. True if it is to go downstream: of the flushes of a seek only the first one begins, and
     * end_seek() ends them. */
    bool begin_flush(MuxInput &input);
    bool end_flush(MuxInput &input);

    /* Around a flushing seek of all inputs that bring a plane each, which are flushed one after the other:
     * those that are done wait for the rest. end_seek() returns whether any was flushed. */
    bool has_planes_apart() const { return inputs_.linked_planes() != 0; }
    void begin_seek();
    bool end_seek();
    void go_on() { gate_.release(); }

private:
    bool place(MuxInput &input, GstBuffer *buffer, PlaneFrame &frame);
    uint64_t number(MuxInput &input, const TimeSpan &time);
    bool wait_for_others(MuxInput &input, uint64_t sweep);
    unsigned planes_for(const MuxInput &input, const GstFocusInfo &focus);
    GstFlowReturn assemble(MuxInput &input, PlaneFrame &frame);
    GstFlowReturn use_shape(const GstFocalStackInfo &shape);
    GstFlowReturn put(PlaneFrame &frame, const GstVideoInfo &info);
    void refuse_damaged(const PlaneFrame &frame, const char *why);
    GstFlowReturn send_outcomes();
    GstFlowReturn finish();
    void update_latency(const GstFocalStackInfo &shape);
    void publish();
    void start_anew();

    GstElement *element_;

    MuxInputs inputs_;
    SweepGate gate_;

    /* stream_ is held while frames are put in place and stacks are sent; inputs, gate and facts_ are locked
     * for a few lines, also while stream_ is held. Who waits at the gate holds nothing. */
    std::mutex stream_;
    MuxSettings settings_;
    MuxOutput output_;
    std::unique_ptr<StackMaker> maker_;
    MuxStatistics counting_;
    bool own_stream_begun_ = false;

    mutable std::mutex facts_;
    MuxStatistics published_;
    GstClockTime latency_ = 0;
    bool seeking_ = false;
    bool flushed_ = false;              /* by the seek */
    std::optional<uint64_t> origin_ns_; /* running time of the first frame on a pad of its own */
};

} // namespace dff
