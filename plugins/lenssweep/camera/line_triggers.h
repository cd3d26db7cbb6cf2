/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "frame_numbers.h"
#include "sweep_timing.h"
#include "sync_rhythm.h"
#include "trigger_count.h"
#include "triggers.h"

#include "lenssweep/lens/lens.h"
#include "lenssweep/trigger/lines.h"

#include <condition_variable>
#include <thread>

namespace dff {

/* Pulses that a sequencer gives to a line of the camera. The run line, or a SequencedLens, starts it and
 * brings it to rest; the sync line tells when plane 0 is exposed.
 *
 * The lens is asked in a thread of its own how many triggers it has given, in each sweep that the sync line
 * tells of, and each second whether all is well: neither frames nor edges wait for its bus. A count that
 * cannot be read is no error; the sync line decides alone until it can. */
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
    std::uint64_t wrong_edges() const override;
    std::optional<std::uint64_t> given() const override;
    std::uint64_t wrong_counts() const override;
    std::string take_complaint() override;

private:
    /* What the labeller looks at. */
    struct Witnesses {
        std::unique_ptr<SyncRhythm> rhythm; /* null without a sync line */
        std::unique_ptr<TriggerCount> count;
    };

    LineTriggers(const SweepTiming &timing, FrameNumbers numbers, const Parts &parts, Witnesses witnesses,
                 std::function<void()> on_error);
    void listen(const std::stop_token &stop);
    void watch_lens(const std::stop_token &stop);
    void check_lens();
    void wait_for_reading(const std::stop_token &stop);
    std::optional<CountReading> read_count();
    void take_count(const TriggerTimes *triggers);

    SweepTiming timing_;
    Parts parts_;
    Witnesses witnesses_;                 /* guarded by mutex_ */
    std::int64_t started_ns_ = 0;         /* likewise */
    std::optional<std::int64_t> read_at_; /* likewise: the count is wanted then */
    std::string complaint_;               /* likewise: not told yet */
    bool complained_ = false;             /* likewise */
    std::condition_variable_any wanted_;  /* read_at_ */
    std::mutex lens_mutex_;               /* guards the lens and the two below; mutex_ is taken within */
    bool started_ = false;
    std::int64_t next_check_ns_ = 0;
    std::jthread listener_;
    std::jthread watcher_;
};

} // namespace dff
