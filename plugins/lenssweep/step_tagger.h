/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "frame_cycle.h"
#include "lens/lens.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>

/* Moves a lens from plane to plane while frames come, and labels those that saw it at rest. A frame can be
 * stamped when its exposure begins or when it was read out; it is taken to be moved through unless its time
 * is a frame period after the lens came to rest. After that, `settle_frames` more are left out. */
class StepTagger {
public:
    /* The lens is prepared for a sweep of `planes` and started. Of frames without a time, only the settle
     * frames are left out. */
    StepTagger(std::unique_ptr<dff::SteppedLens> lens, unsigned planes, unsigned settle_frames);

    void set_period(std::optional<uint64_t> period_ns) { period_ns_ = period_ns.value_or(0); }

    /* The label of a frame with this time, CLOCK_MONOTONIC, or nothing if the lens moved. Then moves the lens
     * on and waits for it to rest, unless `stop` is requested. Throws dff::LensError. */
    std::optional<PlaneLabel> label(std::optional<uint64_t> time_ns, const std::stop_token &stop);

    /* The next label is plane 0 of a new sweep. */
    void restart();

    int code(unsigned plane) const { return lens_->code(plane); }
    bool calibrated() const { return lens_->calibrated(); }

private:
    void position(const std::stop_token &stop);

    std::unique_ptr<dff::SteppedLens> lens_;
    unsigned planes_;
    unsigned settle_frames_;
    uint64_t period_ns_ = 0;

    PlaneLabel next_{0, 0};
    bool positioned_ = false; /* the lens rests at the plane `next_` */
    uint64_t rests_since_ns_ = 0;
    unsigned rested_frames_ = 0;
};
