/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens/lens.h"
#include "swing_check.h"
#include "sync_cycle.h"
#include "trigger/lines.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

/* Labels frames by the edges of a sync line, and watches over the lens that sweeps, if it is ours. */
class SyncTagger {
public:
    /* `lens` may be null: then somebody else runs the sweep. */
    SyncTagger(std::unique_ptr<dff::EdgeLine> line, std::unique_ptr<dff::SweptLens> lens,
               const dff::SweepPlan &plan);

    /* The time between two frames is known: the lens begins to sweep. Throws dff::LensError and
     * std::invalid_argument. */
    void begin(std::chrono::microseconds period);

    /* The label of a frame whose exposure began then, CLOCK_MONOTONIC, or nothing if that is not sure.
     * `sharpness` is called for few frames, and may be empty for pictures that cannot be measured. Throws
     * dff::LineError, and dff::LensError when the lens has stopped by itself. */
    std::optional<PlaneLabel> label(std::optional<uint64_t> time_ns,
                                    const std::function<SwingCheck::Sharpness()> &sharpness);

    int code(unsigned plane) const { return lens_ ? lens_->code(plane) : -1; }
    uint64_t edges() const { return edges_; }
    std::optional<int64_t> misfit_ns() const { return cycle_.misfit_ns(); }

    /* By how much a lens that goes to and fro is later than its labels, as SwingCheck tells. */
    std::optional<std::chrono::microseconds> lag() const;

private:
    std::unique_ptr<dff::EdgeLine> line_;
    std::unique_ptr<dff::SweptLens> lens_;
    dff::SweepPlan plan_;
    SyncCycle cycle_;
    std::chrono::microseconds period_{};
    std::optional<SwingCheck> check_; /* of a lens that goes to and fro */
    uint64_t edges_ = 0;
    unsigned unchecked_ = 0; /* frames since the lens was looked at */
};
