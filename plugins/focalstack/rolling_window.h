/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/frame_verdict.h"

#include <array>
#include <cstdint>
#include <optional>

namespace dff {

/* Knows of each plane the newest frame, so that the last frames of a sweep that goes on make a stack.
 *
 * A source that starts to number its sweeps anew is followed as StackAssembler does. */
class RollingWindow {
public:
    /* Throws std::invalid_argument unless there are 2 to 64 planes. */
    explicit RollingWindow(unsigned planes);

    /* `plane` is below `planes`. */
    FrameVerdict add(uint64_t sweep, unsigned plane);

    /* Planes that were there; bit z is plane z. */
    uint64_t held() const { return held_; }

    /* Whether every plane was there once. */
    bool full() const { return held_ == all_planes(planes_); }

    /* Planes whose newest frame is older than a sweep: the one that should have replaced it was lost. */
    uint64_t stale() const;

    /* Frames that were skipped: counted when the next one of their plane comes. */
    uint64_t lost() const { return lost_; }

    /* Frames taken that came after one of a later sweep, or against the direction of their own. */
    uint64_t reordered() const { return reordered_; }

private:
    bool passed(uint64_t sweep, unsigned plane) const;
    void restart(uint64_t sweep, unsigned plane);
    void put(uint64_t sweep, unsigned plane);

    struct Newest {
        uint64_t sweep;
        unsigned plane;
        SweepDirection direction;
    };

    unsigned planes_;
    std::optional<Newest> newest_;
    std::array<uint64_t, longest_stack> sweep_{};
    uint64_t held_ = 0;
    unsigned late_in_a_row_ = 0;
    uint64_t lost_ = 0;
    uint64_t reordered_ = 0;
};

} // namespace dff
