/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "frame_cycle.h"

#include <cstdint>
#include <deque>
#include <optional>

/* Labels frames of a lens that sweeps by itself and gives an edge as plane 0 of each sweep is exposed; if it
 * goes to and fro, of each second sweep, which the other one follows with its planes in turn from the last. A
 * frame is labelled only if edges and frames agree: the edges are evenly spaced, the frame lies within a
 * quarter of a slot (a sweep by its planes) of its place, and frames have been seen to follow each other from
 * slot to slot. What does not fit is not labelled, and neither is the rest of its sweep. */
class SyncCycle {
public:
    explicit SyncCycle(unsigned planes, bool to_and_fro = false)
        : planes_(planes), slots_(to_and_fro ? 2 * planes : planes)
    {
    }

    /* The next edge, in order of time; times of one clock. */
    void add_edge(uint64_t time_ns);

    /* The plane of a frame whose exposure began then; frames come in order of time. Edges before that time
     * must have been added. */
    std::optional<PlaneLabel> label(uint64_t time_ns);

    /* How far the last frame that was off its place came after it, in ns. */
    std::optional<int64_t> misfit_ns() const { return misfit_ns_; }

private:
    struct Sweep {
        uint64_t begin_ns;
        uint64_t number;
        double slot_ns; /* 0: not known, since the edge before it is missing or out of step */
    };

    std::optional<Sweep> sweep_at(uint64_t time_ns) const;

    PlaneLabel label_of(uint64_t number, uint64_t slot) const;

    unsigned planes_;
    unsigned slots_; /* from edge to edge */
    uint64_t edges_ = 0;
    std::deque<Sweep> sweeps_;            /* the last few */
    std::optional<uint64_t> interval_ns_; /* between edges, as two in a row had it */

    /* Of the frame before. */
    uint64_t time_ns_ = 0;
    uint64_t number_ = UINT64_MAX; /* of its sweep */
    uint64_t slot_ = 0;
    bool void_ = false;   /* something in its sweep did not fit */
    unsigned in_row_ = 0; /* frames that came a slot after the one before, until they are enough */
    std::optional<int64_t> misfit_ns_;
};
