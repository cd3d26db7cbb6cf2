/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "camera_control.h"
#include "camera_frame.h"
#include "plane_labeller.h"
#include "side_thread.h"
#include "trigger_times.h"

#include "lenssweep/lens/lens.h"
#include "lenssweep/trigger/lines.h"

#include <exception>
#include <functional>
#include <memory>
#include <string>

namespace dff {

/* Triggers that are given to a camera, and which of them its frames are of. One thread uses it. */
class Triggers {
public:
    virtual ~Triggers() = default;
    Triggers(const Triggers &) = delete;
    Triggers &operator=(const Triggers &) = delete;

    /* Begins, where that is in our hands with plane 0. The camera is armed. Throws what lens and lines throw.
     */
    virtual void start() = 0;

    /* Where that is in our hands, no trigger is given any more. */
    virtual void stop() noexcept = 0;

    /* Whether stop() brings the triggers to rest and start() begins with plane 0. */
    virtual bool restartable() const = 0;

    /* For poll(): it can be read when there is something to hear; -1 if there is none. */
    virtual int descriptor() const { return -1; }

    /* Takes down what has become known of the triggers; never waits. A frame is to be labelled after a hear()
     * that came after it. Throws if the lens, the camera or a line has failed by itself. */
    virtual void hear() {}

    /* Triggers that were given since the first start(), by the word of who gives them; empty if they are not
     * counted there. */
    virtual std::optional<std::uint64_t> given() const { return std::nullopt; }

    /* Edges of the sync line that were not believed. */
    virtual std::uint64_t wrong_edges() const { return 0; }

    /* Readings of that count which contradict the edges. */
    virtual std::uint64_t wrong_counts() const { return 0; }

    /* What the user should know although labels go on; empty if it was told already. */
    virtual std::string take_complaint() { return {}; }

    FrameVerdict label(const CameraFrame &frame) { return labeller_->label(frame); }
    bool lost() const { return labeller_->lost(); }
    const LabelCounts &counts() const { return labeller_->counts(); }

protected:
    explicit Triggers(std::unique_ptr<PlaneLabeller> labeller) : labeller_(std::move(labeller)) {}

    std::unique_ptr<PlaneLabeller> labeller_;
};

/* A camera that triggers itself: its frames are counted, and nothing moves in step. */
class FreeRun : public Triggers {
public:
    FreeRun(const SweepTiming &timing, FrameNumbers numbers);

    void start() override { labeller_->start(PlaneLabeller::Beginning::UnderWay, 0); }
    void stop() noexcept override {}
    bool restartable() const override { return false; }
};

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

    /* `on_news` is called, from any thread, when there is something to hear() that the descriptor does not
     * tell of. */
    LineTriggers(const SweepTiming &timing, FrameNumbers numbers, const Parts &parts,
                 std::function<void()> on_news);
    ~LineTriggers() override { stop(); }

    void start() override;
    void stop() noexcept override;
    bool restartable() const override { return parts_.lens || parts_.run; }
    int descriptor() const override { return parts_.sync ? parts_.sync->descriptor() : -1; }
    void hear() override;
    std::uint64_t wrong_edges() const override { return rhythm_ ? rhythm_->wrong_edges() : 0; }
    std::optional<std::uint64_t> given() const override;
    std::uint64_t wrong_counts() const override { return count_ ? count_->wrong() : 0; }
    std::string take_complaint() override { return std::exchange(complaint_, {}); }

private:
    /* A reading of the sequencer's count, or why there is none. */
    struct LensNews {
        std::optional<CountReading> reading;
        std::string unreadable;
    };

    void rest_lens();
    void hear_edges();
    void hear_lens(const TriggerTimes *triggers);
    std::int64_t reading_time(std::int64_t edge_ns) const;
    void watch_lens(const std::stop_token &stop);
    LensNews read_count() const;
    std::optional<CountReading> take(const LensNews &news);
    void take_count(const LensNews &news, const TriggerTimes *triggers);

    SweepTiming timing_;
    Parts parts_;
    std::unique_ptr<SyncRhythm> rhythm_;     /* null without a sync line */
    std::unique_ptr<TriggerCount> count_;    /* null without a lens */
    std::optional<std::int64_t> started_ns_; /* while they are given; edges before are of other ones */
    std::string complaint_;                  /* not told yet */
    bool complained_ = false;
    std::exception_ptr error_; /* of stop(); the next hear() throws it */
    SideThread<LensNews> lens_thread_;
};

/* Commands of this host's, one a period or, with a SteppedLens, as soon after it as the lens rests. A thread
 * of its own moves the lens and gives them: they wait for no frame. */
class SoftwareTriggers : public Triggers {
public:
    /* The lens may be null. Both outlive this object. `on_news` as above. */
    SoftwareTriggers(const SweepTiming &timing, FrameNumbers numbers, CameraControl &camera,
                     SteppedLens *lens, std::function<void()> on_news);
    ~SoftwareTriggers() override { stop(); }

    void start() override;
    void stop() noexcept override;
    bool restartable() const override { return true; }
    void hear() override;

private:
    SoftwareTriggers(const SweepTiming &timing, FrameNumbers numbers, CameraControl &camera,
                     SteppedLens *lens, std::unique_ptr<SentTriggers> sent, std::function<void()> on_news);
    void send(const std::stop_token &stop);
    bool settle(unsigned plane, const std::stop_token &stop);

    SweepTiming timing_;
    CameraControl &camera_;
    SteppedLens *lens_;
    std::unique_ptr<SentTriggers> sent_;
    std::int64_t next_sweep_ = -1; /* of the sending thread, while there is one */
    std::exception_ptr error_;     /* of stop(); the next hear() throws it */
    SideThread<Trigger> sender_;
};

} // namespace dff
