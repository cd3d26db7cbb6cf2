/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "frame_cycle.h"
#include "lens/open_lens.h"
#include "step_tagger.h"
#include "sync_tagger.h"
#include "tag_settings.h"

#include <memory>
#include <optional>
#include <stop_token>
#include <string>

/* Labels frames as the mode of lenssweeptag says, with the lens and the line that it needs. */
class SweepTagger {
public:
    using FindProperty = decltype(dff::LensSurroundings::find_property);

    /* Opens lens and line; `find_property` finds that of lens=element:. Throws std::invalid_argument for
     * settings that cannot be used, dff::LensError and dff::LineError for devices. */
    SweepTagger(const TagSettings &settings, const FindProperty &find_property);

    /* The time between two frames of the stream, if it is known. A lens of ours that sweeps by itself begins
     * to; throws std::invalid_argument if it cannot keep that time, and dff::LensError. */
    void set_period(std::optional<uint64_t> period_ns);

    /* After a flush. */
    void restart();

    /* The label of a frame, or nothing if it is to be dropped; `time_ns` is its timestamp on CLOCK_MONOTONIC.
     * A wait for the lens ends when `stop` is requested; `sharpness` is that of the frame, as StepTagger and
     * SyncTagger ask for it. Throws dff::LensError and dff::LineError. */
    std::optional<PlaneLabel> label(const FrameTrace &trace, std::optional<uint64_t> time_ns,
                                    const std::stop_token &stop,
                                    const std::function<StepTagger::Sharpness()> &sharpness);

    /* What the user must be told after the last frame, once for each cause; mostly empty. */
    std::string warning();

    unsigned planes() const { return plan_.planes(); }

    /* Vergence in dioptres; NAN if neither the user says it, nor a calibration, nor a lens that is moved
     * here. */
    double power(unsigned plane) const;

    /* Of a microscope's stage, in micrometres; NAN if the user does not say it. */
    double position_um(unsigned plane) const { return settings_.stage.of(plane); }

    /* What the lens is told for a plane, or -1. */
    int code(unsigned plane) const;

private:
    enum class Cause { LostPlace, NeverRests, StillMoves, LateLens, Untimed, NoEdges, Misfit };

    std::string tell_once(Cause cause, const std::string &text);
    void open_step(std::unique_ptr<dff::Lens> lens);
    void open_sync(std::unique_ptr<dff::Lens> lens);
    std::string sync_warning() const;
    std::string step_warning() const;
    std::string swing_warning(std::chrono::microseconds lag) const;

    TagSettings settings_;
    dff::SweepPlan plan_;
    std::vector<double> calibrated_powers_; /* by a file; empty: there is none */
    bool lens_sweeps_ = false;              /* it is one of ours that does */
    unsigned unlabelled_ = 0;               /* frames in a row, as is the next one */
    unsigned untimed_ = 0;
    unsigned told_ = 0; /* causes */

    /* One of them is there, by mode. */
    std::optional<FrameCycle> cycle_;
    std::unique_ptr<StepTagger> step_;
    std::unique_ptr<SyncTagger> sync_;
};
