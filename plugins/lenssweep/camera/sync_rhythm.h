/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "sweep_timing.h"
#include "trigger_times.h"

#include <deque>
#include <vector>

namespace dff {

/* The triggers that the sync line tells of: each edge is plane 0 of a sweep, and edges come one sweep apart.
 * An edge that is doubled or out of this rhythm is counted and not believed; three in a row that are one
 * sweep apart begin a new rhythm. Edges that are missing make their sweep unknown, and do no more harm. */
class SyncRhythm : public TriggerTimes {
public:
    explicit SyncRhythm(const SweepTiming &timing) : timing_(timing) {}

    /* Whether the edge is believed. Edges may come late and out of order. */
    bool edge(std::int64_t time_ns);

    std::uint64_t wrong_edges() const { return wrong_edges_; }

    void restart() override;
    unsigned rhythm() const override { return rhythm_; }
    std::optional<Trigger> first() const override { return first_; }
    unsigned proofs() const override { return contradicted_ ? 0 : fitting_; }
    std::optional<Trigger> nearest(std::int64_t time_ns) const override;
    std::int64_t time_of(std::int64_t index) const override;

private:
    struct Edge {
        std::int64_t sweep;
        std::int64_t time_ns;
    };

    std::int64_t tolerance_ns() const { return timing_.period_ns / 8; }
    std::optional<std::int64_t> sweeps_between(std::int64_t from_ns, std::int64_t to_ns) const;
    bool believe(const Edge &edge);
    bool doubt(std::int64_t time_ns);

    SweepTiming timing_;
    std::deque<Edge> edges_; /* believed, in order of time, the last few */
    std::int64_t next_sweep_ = 0;
    std::optional<Trigger> first_;
    std::vector<std::int64_t>
        doubted_ns_;       /* edges out of the rhythm, but a sweep apart; none in it came since */
    unsigned fitting_ = 0; /* edges believed since the restart */
    bool contradicted_ = false;
    std::uint64_t wrong_edges_ = 0;
    unsigned rhythm_ = 0;
};

} // namespace dff
