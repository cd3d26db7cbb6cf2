/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/mux_inputs.h"
#include "focalstack/mux_output.h"
#include "focalstack/stack_maker.h"
#include "focalstack/stack_watch.h"
#include "focalstack/sweep_gate.h"

#include <gst/gst.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

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
    MuxStatistics statistics() const;
    GstClockTime latency() const;

    /* The input's pad was linked or unlinked, or is about to be removed: others wait for its frames, or do
     * so no more. */
    void open_input(MuxInput &input);
    void close_input(MuxInput &input);

    /* The pad is removed, at first for the others, then for its thread, too, which must be out by then. */
    void release_input(MuxInput &input);
    void remove_input(GstPad *pad) { inputs_.remove(pad); }

    /* Whether no input is open any more and the stream did not end yet; and ends it if so. That blocks as
     * long as downstream does: it is not for a thread that the application waits for. */
    bool is_running() const { return running_; }
    bool end_is_due() const;
    void end_if_due(GstEvent *eos = nullptr, const MuxInput *last = nullptr);

    /* Around the streaming. start() returns false, with the error posted, if the pads make no sense. */
    bool start(const MuxSettings &settings);
    void stop();

    /* The input's streaming thread; events are taken over. A closed input's take() returns at once. */
    GstFlowReturn take(MuxInput &input, GstBuffer *buffer);
    bool set_caps(MuxInput &input, const GstCaps *caps);
    void set_segment(MuxInput &input, const GstSegment &segment, guint32 seqnum);
    bool pass_gap(MuxInput &input, GstEvent *gap);
    void begin(MuxInput &input, GstEvent *stream_start);
    void end(MuxInput &input, GstEvent *eos);

    /* Wakes who waits for others; nobody waits until start(). */
    void unblock() { gate_.shut(); }

    /* Around a flush. What one plane's flush does not reach goes on. */
    void begin_flush(MuxInput &input, GstEvent *flush_start);
    void end_flush(MuxInput &input, GstEvent *flush_stop);

    /* Around a flushing seek of all inputs that bring a plane each, which are flushed one after the other:
     * those that are done wait for the rest, and downstream sees one flush. */
    bool has_planes_apart() const { return inputs_.linked_planes() != 0; }
    void begin_seek();
    void end_seek(guint32 seqnum);

private:
    /* What of the output is flushing. */
    enum class Flush { None, Downstream, Stream };

    bool place(MuxInput &input, GstBuffer *buffer, PlaneFrame &frame);
    uint64_t number(MuxInput &input, const TimeSpan &time);
    bool widen_flush(const MuxInput &input, FlushReach reach);
    Flush narrow_flush(const MuxInput &input);
    GatePass enter(MuxInput &input, uint64_t sweep);
    GstFlowReturn take_placed(MuxInput &input, PlaneFrame &frame);
    unsigned planes_for(const MuxInput &input, const GstFocusInfo &focus);
    GstFlowReturn assemble(MuxInput &input, PlaneFrame &frame);
    GstFlowReturn use_shape(const MuxInput &input, const GstFocalStackInfo &shape);
    GstFlowReturn put(const MuxInput &input, PlaneFrame &frame);
    void refuse_damaged(const PlaneFrame &frame, const std::string &why);
    GstFlowReturn send_outcomes(const MuxInput *input);
    GstFlowReturn finish(const MuxInput *input);
    void send_end(GstEvent *eos, const MuxInput *last);
    void finish_and_tell(const MuxInput *input);
    void update_latency(const GstFocalStackInfo &shape);
    void publish();
    void warn_of_missing_stacks();
    void start_anew();

    GstElement *element_;

    MuxInputs inputs_;
    SweepGate gate_;

    /* stream_ is held while frames are put in place and stacks are sent; inputs, gate and facts_ are locked
     * for a few lines, also while stream_ is held. Who waits at the gate holds nothing. Whoever flushes takes
     * stream_ only once downstream was flushed, so that nobody can be blocked there who has it. */
    std::mutex stream_;
    MuxSettings settings_;
    MuxOutput output_;
    std::unique_ptr<StackMaker> maker_;
    MuxStatistics counting_;
    StackWatch watch_;
    bool damage_told_ = false;
    std::atomic<bool> running_ = false; /* written with stream_ held, as are the next two */
    std::atomic<bool> stream_begun_ = false;
    std::atomic<bool> ended_ = false; /* the end was sent */

    mutable std::mutex facts_;
    MuxStatistics published_;
    GstClockTime latency_ = 0;
    bool seeking_ = false;
    Flush flush_ = Flush::None;
    std::optional<unsigned> flushed_for_; /* the plane that Flush::Downstream is for */
    std::optional<uint64_t> origin_ns_;   /* running time of the first frame on a pad of its own */
};

} // namespace dff
