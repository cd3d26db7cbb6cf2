/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "frame_cycle.h"
#include "lens/lens.h"
#include "settle_check.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

/* Moves a lens from plane to plane while frames come, and labels those that saw it at rest. A frame can be
 * stamped when its exposure begins or when it was read out; it is taken to be moved through unless its time
 * is a frame period after the lens came to rest, and where the camera says where its lens was, unless that is
 * the plane. After that, `settle_frames` more are left out. */
class StepTagger {
public:
    using Sharpness = SettleCheck::Sharpness;

    /* The lens is prepared for a sweep of `planes` and started. Of frames without a time, those are left out
     * that were there when the lens was moved, and the settle frames. */
    StepTagger(std::unique_ptr<dff::SteppedLens> lens, unsigned planes, unsigned settle_frames);

    void set_period(std::optional<uint64_t> period_ns) { period_ns_ = period_ns.value_or(0); }

    /* The label of a frame with this time, CLOCK_MONOTONIC, or nothing if the lens moved, or is held to see
     * whether it had come to rest. Then moves the lens on and waits for it to rest, unless `stop` is
     * requested. `sharpness` is called for few frames; none, or an empty answer, for pictures that cannot be
     * measured. Throws dff::LensError. */
    std::optional<PlaneLabel> label(std::optional<uint64_t> time_ns, const std::stop_token &stop,
                                    const std::function<Sharpness()> &sharpness = {});

    /* The next label is plane 0 of a new sweep. */
    void restart();

    int code(unsigned plane) const { return lens_->code(plane); }
    bool calibrated() const { return lens_->calibrated(); }

    /* As SettleCheck: that frames are labelled while the lens moves. */
    std::optional<double> lag() const { return check_ ? check_->lag() : std::nullopt; }

private:
    void position(const std::stop_token &stop);
    bool has_plane(std::optional<uint64_t> time_ns);
    bool is_held(const std::function<Sharpness()> &sharpness);

    std::unique_ptr<dff::SteppedLens> lens_;
    unsigned planes_;
    unsigned settle_frames_;
    uint64_t period_ns_ = 0;

    PlaneLabel next_{0, 0};
    bool positioned_ = false; /* the lens rests at the plane `next_` */
    uint64_t rests_since_ns_ = 0;
    unsigned rested_frames_ = 0;

    std::optional<SettleCheck> check_; /* where nobody knows when the lens rests */
    unsigned held_ = 0;                /* frames of the plane before `next_`; 0: it is not held */

    /* What a camera says may be of a later frame than the one that comes in just now, if frames have piled
     * up: then they are later than they can be. */
    std::optional<int64_t> least_age_ns_; /* of frames as they come in */
    std::optional<int64_t> has_plane_since_ns_;
};
