/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens/lens.h"
#include "sync_cycle.h"
#include "trigger/lines.h"

#include <cstdint>
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

    /* The label of a frame whose exposure began then, CLOCK_MONOTONIC, or nothing if that is not sure. Throws
     * dff::LineError, and dff::LensError when the lens has stopped by itself. */
    std::optional<PlaneLabel> label(std::optional<uint64_t> time_ns);

    int code(unsigned plane) const { return lens_ ? lens_->code(plane) : -1; }
    uint64_t edges() const { return edges_; }
    std::optional<int64_t> misfit_ns() const { return cycle_.misfit_ns(); }

private:
    std::unique_ptr<dff::EdgeLine> line_;
    std::unique_ptr<dff::SweptLens> lens_;
    dff::SweepPlan plan_;
    SyncCycle cycle_;
    uint64_t edges_ = 0;
    unsigned unchecked_ = 0; /* frames since the lens was looked at */
};
