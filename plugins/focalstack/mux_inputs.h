/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/frame_numbering.h"

#include <gst/video/video.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace dff {

/* The frames of an input since it has its caps. */
struct SweepRange {
    uint64_t first;
    uint64_t last;
};

/* What the mux knows of one of its sink pads. Belongs to the pad's streaming thread; what other threads look
 * at is guarded by MuxInputs. */
struct MuxInput {
    enum class State { Open, Flushing, Ended };

    MuxInput(GstPad *sink_pad, std::optional<unsigned> of_plane) : pad(sink_pad), plane(of_plane) { reset(); }
    void reset();

    /* A stream begins, or goes on after a flush: what belonged to the old one is forgotten. */
    void begin_stream();

    /* Asked for once a stream. */
    bool is_live();

    /* Running time, or GST_CLOCK_TIME_NONE where the segment does not count in time. */
    GstClockTime running_time(GstClockTime time) const;

    GstPad *pad;
    std::optional<unsigned> plane; /* empty: frames of all planes come here */
    GstSegment segment;
    FrameNumbering numbering;
    std::optional<bool> live;
    bool caps_changed; /* since the last frame */

    /* Guarded by MuxInputs; the streaming thread alone writes `info` and may read it without. */
    bool released = false; /* its thread may not be out of the mux yet */
    State state;
    bool has_caps;
    GstVideoInfo info;
    std::optional<SweepRange> sweeps;
};

/* How far the flush of one input reaches. */
enum class FlushReach {
    Plane,      /* its own frames only */
    Downstream, /* also what it is pushing: else its thread could not be had back */
    Stream,     /* no other input is open: the mux begins anew */
};

/* The mux's sink pads, one for all planes or one for each, and the state that each is in. May be called from
 * any thread. */
class MuxInputs {
public:
    MuxInput &add(GstPad *pad, std::optional<unsigned> plane);
    void remove(GstPad *pad);

    /* The pad is about to be removed: no other input cares for this one any more. */
    void release(MuxInput &input);

    /* Before streaming. */
    void reset();

    /* Which planes have a linked pad of their own: bit z is plane z. */
    uint64_t linked_planes() const;

    /* Posts an error on `element` and returns false unless one pad for all planes or one for each is linked,
     * the latter without a hole where `planes` is 0. */
    bool make_sense(GstElement *element, unsigned planes) const;

    /* False if the caps are not those of a picture. */
    bool set_caps(MuxInput &input, const GstCaps *caps);

    /* The input brings a frame of this sweep. If another brought one with other caps: what is wrong, for the
     * user. */
    std::optional<std::string> arrive(MuxInput &input, uint64_t sweep);

    void reopen(MuxInput &input);
    void end(MuxInput &input);

    /* Whether no linked input is open or flushing. */
    bool all_ended() const;

    /* The input is flushing until it is reopened. */
    FlushReach begin_flush(MuxInput &input);

    bool is_flushing(const MuxInput &input) const;

    /* Around what the thread of `input` (or of none) pushes downstream. False if the input is flushing, so
     * that nothing may be pushed. */
    bool begin_push(const MuxInput *input);
    void end_push();

private:
    bool all_in_one_linked() const;

    mutable std::mutex mutex_; /* a leaf: nothing else is locked while it is held */
    std::vector<std::unique_ptr<MuxInput>> inputs_;
    const MuxInput *pushing_ = nullptr;
};

} // namespace dff
