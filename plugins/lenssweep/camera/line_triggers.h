/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "frame_numbers.h"
#include "sweep_timing.h"
#include "sync_rhythm.h"
#include "triggers.h"

#include "lenssweep/lens/lens.h"
#include "lenssweep/trigger/lines.h"

#include <thread>

namespace dff {

/* Pulses that a sequencer gives to a line of the camera. The run line, or a SequencedLens, starts it and
 * brings it to rest; the sync line tells when plane 0 is exposed. */
class LineTriggers : public Triggers {
public:
    /* Each of the three may be null; they outlive this object. */
    struct Parts {
        SequencedLens *lens = nullptr;
        OutputLine *run = nullptr;
        EdgeLine *sync = nullptr;
    };

    LineTriggers(const SweepTiming &timing, FrameNumbers numbers, const Parts &parts,
                 std::function<void()> on_error);
    ~LineTriggers() override;

    void start() override;
    void stop() noexcept override;
    bool restartable() const override { return parts_.lens || parts_.run; }
    void check() override;
    std::uint64_t wrong_edges() const override;
    std::optional<std::uint64_t> given() const override;

private:
    LineTriggers(const SweepTiming &timing, FrameNumbers numbers, const Parts &parts,
                 std::unique_ptr<SyncRhythm> rhythm, std::function<void()> on_error);
    void count_given();
    void listen(const std::stop_token &stop);

    Parts parts_;
    std::unique_ptr<SyncRhythm> rhythm_; /* guarded by mutex_; null without a sync line */
    std::int64_t started_ns_ = 0;        /* guarded by mutex_ */
    std::uint64_t given_ = 0;            /* guarded by mutex_ */
    std::optional<std::uint32_t> count_; /* the lens's, which began before us and wraps */
    std::jthread listener_;
};

} // namespace dff
