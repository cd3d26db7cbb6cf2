/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/frame_verdict.h"
#include "focalstack/mux_statistics.h"
#include "focalstack/partial_stack.h"

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

namespace dff {

/* What is done with a stack of which planes are missing. */
enum class OnMissing { Drop, Hold, Repeat };

enum class StackWindow { Sweep, Rolling };

/* A stack to send, or, where `stack` is empty, the time of a stack or frame that was lost. */
struct Outcome {
    BufferPtr stack;
    TimeSpan time;
};

/* Frames in, stacks out: a strategy for each window. */
class StackMaker {
public:
    /* Counts into `statistics`, and numbers the stacks by it; whoever makes frames counts them. */
    static std::unique_ptr<StackMaker> create(StackWindow window, const GstFocalStackInfo &info,
                                              OnMissing on_missing, unsigned allowance,
                                              MuxStatistics &statistics);
    virtual ~StackMaker() = default;

    /* Frames of later sweeps that may come before the last one of a sweep that waits for it. */
    static constexpr unsigned default_allowance = 2;

    const GstFocalStackInfo &info() const { return pool_.info(); }

    /* False if there is no memory for a stack. The focus says sweep and plane; plane is below info().planes.
     */
    virtual bool add(const PlaneFrame &frame) = 0;

    /* The stream ends: what was begun is dropped or filled. */
    virtual void finish() = 0;

    std::optional<Outcome> next_outcome();

protected:
    StackMaker(const GstFocalStackInfo &info, OnMissing on_missing, MuxStatistics &statistics);

    unsigned planes() const { return pool_.info().planes; }
    bool put(PartialStack &stack, const PlaneFrame &frame);
    void refuse(const PlaneFrame &frame, FrameVerdict verdict);
    void drop_stack(TimeSpan time, uint64_t missing);
    void send(PartialStack &stack, uint64_t filled);

    /* Puts the nearest plane of `fresh` into every other one. */
    void fill_from_neighbours(PartialStack &stack, uint64_t fresh) const;

    /* Of a plane that is not fresh, in dioptres: what it was last, or else what the fresh planes make of it.
     */
    double power_of(const PartialStack &stack, unsigned plane, uint64_t fresh) const;

    StackPool pool_;
    OnMissing on_missing_;
    MuxStatistics &statistics_;

private:
    std::deque<Outcome> outcomes_;
    std::array<double, longest_stack> powers_; /* of each plane when last seen, dioptres, or NAN */
};

} // namespace dff
