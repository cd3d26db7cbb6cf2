/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <optional>

/* What is known of a frame beside its pixels. */
struct FrameTrace {
    std::optional<uint64_t> number;  /* the source's count of frames, lost ones included */
    std::optional<uint64_t> time_ns; /* of its exposure */
    bool discontinuous = false;      /* something before it is missing */
};

struct PlaneLabel {
    uint64_t sweep;
    unsigned plane;
};

/* Labels frames of a lens that cycles through its planes without end, by counting. Frames that were lost are
 * counted too: by the source's numbers, else, at a discontinuity, by the time that passed. Where neither says
 * how many are missing the next frame begins a new sweep, and the cycle reports that it lost its place. */
class FrameCycle {
public:
    /* `period_ns` is the time between two frames, if it is known. */
    FrameCycle(unsigned planes, std::optional<uint64_t> period_ns);

    void set_period(std::optional<uint64_t> period_ns) { period_ns_ = period_ns; }

    /* The next frame begins a new sweep. */
    void restart();

    PlaneLabel label(const FrameTrace &frame);

    /* Whether the last label had to be a new sweep. */
    bool lost_place() const { return lost_place_; }

private:
    std::optional<uint64_t> steps_to(const FrameTrace &frame) const;

    unsigned planes_;
    std::optional<uint64_t> period_ns_;
    std::optional<uint64_t> count_; /* of the last frame: sweep * planes + plane */
    uint64_t restart_at_ = 0;
    FrameTrace last_;
    bool lost_place_ = false;
};
