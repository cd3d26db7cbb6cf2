/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens_error.h"

#include "optics/sweep_plan.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <stop_token>

namespace dff {

/* The sweep that a lens is asked for. */
struct LensSweep {
    SweepPlan plan;
    std::chrono::microseconds period{};   /* from one exposure to the next; of no use to a stepped lens */
    std::chrono::microseconds exposure{}; /* during which the lens rests; of no use to a stepped lens */
    bool gated = false;                   /* a sequencer sweeps only while its run line is high */
};

/* A lens that is swept: a SweptLens, which sweeps by itself, a SteppedLens, which is moved from plane to
 * plane, or neither, if nobody here moves it.
 *
 * The order of calls is prepare(), start(), moves, stop(), as often as wanted. Transfers that fail are tried
 * again a few times; then the lens is left in its safe state and LensError is thrown. Not thread safe, but
 * for the std::stop_token of waits.
 */
class Lens {
public:
    /* As stop(). */
    virtual ~Lens() = default;

    Lens() = default;
    Lens(const Lens &) = delete;
    Lens &operator=(const Lens &) = delete;

    /* Takes a sweep up; nothing moves yet. Throws std::invalid_argument, with the range in its text, for
     * powers that the lens cannot reach and times that it cannot keep. */
    virtual void prepare(const LensSweep &sweep) = 0;

    /* Wakes the lens. A sequencer begins with plane 0 (if gated, as soon as the run line is high), so the
     * camera is armed before. */
    virtual void start() = 0;

    /* The safe state: no trigger is given any more, and the lens rests. */
    virtual void stop() = 0;

    /* Whether the powers of the plan are dioptres that the lens was calibrated in. If not, planes are in
     * order, nearest first, and that is all. */
    virtual bool calibrated() const = 0;

    /* What the lens is told for a plane of the prepared sweep, for GstFocusMeta; -1 if that is no number. */
    virtual int code(unsigned plane) const = 0;
};

/* A lens that is moved to a plane, and then exposed. */
class SteppedLens : public Lens {
public:
    /* Begins to move. */
    virtual void move_to(unsigned plane) = 0;

    /* Waits until the lens rests at its plane. False if `stop` was requested before; throws LensError if the
     * lens does not come to rest within a time that is far too long for it. */
    virtual bool wait_settled(const std::stop_token &stop) = 0;

    /* For a lens that moves while frames come: whether its camera says that frames have the plane by now.
     * Nothing if it does not say. */
    virtual std::optional<bool> at_plane() { return std::nullopt; }

    /* Whether wait_settled() knows when the lens rests; if not, it is the user who says how long it moves. */
    virtual bool knows_rest() const { return true; }
};

/* A lens that sweeps by itself, and gives an edge as it stands at the near end. */
class SweptLens : public Lens {
public:
    /* Throws LensError, with the reason, if it has stopped by itself. */
    virtual void check() = 0;

    /* Whether it comes back as it went, plane by plane, so that from edge to edge there are two sweeps; if
     * not, it begins with plane 0 again. */
    virtual bool goes_to_and_fro() const { return false; }
};

/* A lens in the hands of a sequencer, which triggers the camera and numbers sweeps. */
class SequencedLens : public SweptLens {
public:
    /* Sweeps begun since the sequencer's reset: one for each pulse of the sync line. A count that cannot be
     * read throws LensError, and the sweep goes on. */
    virtual std::uint32_t sweep_count() = 0;

    /* Triggers given since the sequencer's reset; likewise. */
    virtual std::uint32_t frame_count() = 0;
};

} // namespace dff
