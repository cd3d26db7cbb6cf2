/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/frame_verdict.h"

#include <cstdint>
#include <deque>
#include <optional>

namespace dff {

/* A sweep that is over. Bit z of `present` is set where plane z came; 0 where not one frame did. */
struct FinishedSweep {
    uint64_t sweep;
    uint64_t present;

    bool operator==(const FinishedSweep &) const = default;
};

/* Sorts frames into sweeps by their sweep and plane number, whatever order they come in.
 *
 * A sweep is over when all of its planes are there, or when more than `allowance` frames of later sweeps have
 * come: so many frames may overtake one that still fits. Sweeps end in the order of their numbers, each
 * exactly once, those of which no frame came included.
 *
 * A source that starts to number its sweeps anew is followed: as soon as longest_delay() frames in a row came
 * late, or at once where the number leaps by more than `longest_gap`. */
class StackAssembler {
public:
    /* Throws std::invalid_argument unless there are 2 to 64 planes. */
    StackAssembler(unsigned planes, unsigned allowance);

    /* `plane` is below `planes`. Take what next_finished() has before the next frame. */
    FrameVerdict add(uint64_t sweep, unsigned plane);

    /* Ends all sweeps that were begun. */
    void finish();

    /* The next sweep that is over, in order. */
    std::optional<FinishedSweep> next_finished();

    /* Frames taken that came after one of a later sweep, or against the direction of their own. */
    uint64_t reordered() const { return reordered_; }

private:
    struct OpenSweep {
        uint64_t sweep;
        uint64_t present;
        unsigned overtaken;
        SweepDirection direction;
        unsigned last_plane;
    };

    FrameVerdict add_late(uint64_t sweep, unsigned plane);
    void begin(uint64_t sweep);
    void open_up_to(uint64_t sweep);
    void put(OpenSweep &open, unsigned plane);
    void close_front();
    void close_what_is_over();

    unsigned planes_;
    unsigned allowance_;
    std::deque<OpenSweep> open_; /* consecutive numbers, oldest first */
    std::deque<FinishedSweep> finished_;
    std::optional<uint64_t> next_sweep_; /* number of the oldest sweep that is not over */
    unsigned late_in_a_row_ = 0;
    uint64_t reordered_ = 0;
};

} // namespace dff
