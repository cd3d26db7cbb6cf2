/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "camera_frame.h"
#include "trigger_times.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace dff {

struct FrameLabel {
    std::uint64_t sweep;
    unsigned plane;
    std::optional<std::int64_t> trigger_ns; /* of the host's CLOCK_MONOTONIC, where triggers are seen */
};

/* Why a frame has no label. */
enum class Unlabelled {
    Seeking,   /* not yet known which trigger is which frame's */
    Invalid,   /* the camera cannot have given this number */
    Doubled,   /* it was here already */
    NoTrigger, /* no trigger is known that it could be of: the edge of its sweep is missing or late */
    Disagree,  /* its number, its time and the triggers do not agree, or did not before in this sweep */
    Incomplete /* packets of it are missing */
};
constexpr std::size_t unlabelled_reasons = 6;

/* For a log. */
const char *name_of(Unlabelled reason);

struct FrameVerdict {
    std::optional<FrameLabel> label;
    Unlabelled reason = Unlabelled::Seeking; /* if there is no label */
};

struct LabelCounts {
    std::uint64_t labelled = 0;
    std::uint64_t unlabelled = 0;
    std::uint64_t lost = 0;    /* numbers that never came */
    std::uint64_t doubled = 0; /* frames that came twice */
    std::uint64_t disagreements =
        0; /* frames at odds with the triggers: one that the camera missed, mostly */
    std::uint64_t dropped_sweeps = 0; /* sweeps in which not every frame that came has a label */
};

/* Tells which plane of which sweep a frame is, and no label rather than one that may be wrong. */
class PlaneLabeller {
public:
    virtual ~PlaneLabeller() = default;

    /* How the triggers begin. FromRest: none is given before `host_ns`, and the first one is plane 0. */
    enum class Beginning { FromRest, UnderWay };

    /* Forgets how frames and triggers go together. */
    virtual void start(Beginning beginning, std::int64_t host_ns) = 0;

    /* Frames in the order they come. */
    virtual FrameVerdict label(const CameraFrame &frame) = 0;

    /* Whether no label will come any more unless the triggers are stopped and start() is called. */
    virtual bool lost() const = 0;

    virtual const LabelCounts &counts() const = 0;
};

/* Follows the numbers of frames, and counts what they tell: frames that were lost, and those that came twice.
 */
class FrameLedger {
public:
    FrameLedger(FrameNumbers numbers, LabelCounts &counts) : numbers_(numbers), counts_(counts) {}

    /* The next number has nothing to do with those before. */
    void restart();

    /* Why a frame can have no label, whatever its time; empty if nothing is wrong with its number. */
    std::optional<Unlabelled> enter(std::uint64_t id);

    /* The sweep is one of those that are dropped; counted once. */
    void drop_sweep(std::uint64_t sweep);
    bool dropped(std::uint64_t sweep) const { return dropped_ == sweep; }

private:
    bool seen(std::uint64_t id) const;

    FrameNumbers numbers_;
    LabelCounts &counts_;
    std::array<std::optional<std::uint64_t>, 64> recent_;
    std::size_t next_ = 0;
    std::optional<std::uint64_t> newest_;
    std::optional<std::uint64_t> dropped_;
};

/* Labels frames whose triggers nobody sees: it counts. The first frame is plane 0; from then on the numbers
 * of the frames tell the plane. Where they are of triggers, the time that passed between two frames must be
 * that of as many periods. If it is not, the triggers rested or the camera missed one, and nothing tells
 * which: no frame has a label until start() is called. A camera that triggers itself misses nothing, and its
 * times do not matter.
 *
 * After a beginning from rest the first frame must have arrived within an exposure and a period, else the
 * first ones may be lost. */
class CountingLabeller : public PlaneLabeller {
public:
    enum class Counts { Triggers, FreeRun };

    CountingLabeller(const SweepTiming &timing, FrameNumbers numbers, Counts what = Counts::Triggers);

    void start(Beginning beginning, std::int64_t host_ns) override;
    FrameVerdict label(const CameraFrame &frame) override;
    bool lost() const override { return lost_; }
    const LabelCounts &counts() const override { return counts_; }

private:
    struct Placed {
        CameraFrame frame;
        std::int64_t index;
    };

    FrameVerdict place(const CameraFrame &frame);
    bool is_first(const CameraFrame &frame) const;
    bool agrees(const CameraFrame &frame, std::int64_t index) const;
    FrameVerdict give_up();

    SweepTiming timing_;
    FrameNumbers numbers_;
    Counts what_;
    LabelCounts counts_;
    FrameLedger ledger_{numbers_, counts_};
    std::optional<std::int64_t> rested_until_ns_;
    std::optional<Placed> newest_;
    std::int64_t next_sweep_ = 0;
    bool lost_ = false;
};

/* Notices when frames come and labels stay away, and says it once for each cause: a stream that only counts
 * what it drops looks like one that hangs. */
class LabelWatch {
public:
    explicit LabelWatch(unsigned planes) : planes_(planes) {}

    /* A frame and its verdict, with the number of sweeps that were dropped until then. */
    void judged(const FrameVerdict &verdict, std::uint64_t dropped_sweeps);

    /* What the user should know; empty if it was told already. */
    std::string take_complaint() { return std::exchange(complaint_, {}); }

private:
    void labelled(const FrameLabel &label);
    void complain(const std::string &what);
    Unlabelled main_reason() const;

    unsigned planes_;
    std::array<unsigned, unlabelled_reasons> reasons_{}; /* of frames since the last whole sweep */
    unsigned unlabelled_in_row_ = 0;
    std::uint64_t dropped_sweeps_ = 0;
    unsigned dropped_in_row_ = 0; /* with no whole sweep between them */
    std::uint64_t sweep_ = 0;     /* of the last label */
    unsigned labels_ = 0;         /* in it */
    std::set<Unlabelled> told_;
    std::string complaint_;
};

} // namespace dff
