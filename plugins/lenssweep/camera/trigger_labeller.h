/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "plane_labeller.h"
#include "trigger_times.h"

#include <optional>
#include <vector>

namespace dff {

/* How the clock of a camera's frames goes with the host's, at the moments of triggers. */
struct CameraAnchor {
    std::int64_t offset_ns;  /* time of a frame - time of its trigger */
    std::int64_t latency_ns; /* from a trigger to the arrival of its frame, at the fastest */
    std::int64_t index;      /* of the trigger of the last frame that was added */
};

/* Finds out which trigger the first frames are of. Two facts must say the same:
 *
 * - a frame is here no sooner than its exposure ends and its bytes have crossed the link, and, if nothing
 * delays it, no later than one period after that;
 * - after a beginning from rest, the first frame is of the first trigger. Were it of a later one, every frame
 * would seem to take a period more. So the search goes on for some sweeps if all were delayed, on a machine
 * that is slow to begin.
 *
 * Where the triggers were under way already the first fact stands alone: then it must hold over three sweeps,
 * and with a margin at both ends. A machine that lags all that time, by a period or more, would deceive it.
 */
class AnchorSearch {
public:
    AnchorSearch(const SweepTiming &timing, FrameNumbers numbers) : timing_(timing), numbers_(numbers) {}

    void start(PlaneLabeller::Beginning beginning);

    /* Triggers were under way, and the camera's clock was known before; it is no more than `off_ns` off. */
    void resume(const CameraAnchor &before, std::int64_t off_ns);

    /* A frame, and what is known of the triggers when it comes. */
    std::optional<CameraAnchor> add(const CameraFrame &frame, const TriggerTimes &triggers);

    /* Frames and triggers contradict each other; after a beginning from rest, for good. */
    bool failed() const { return failed_; }

private:
    std::size_t needed() const;
    std::size_t most() const;
    bool near_the_one_before(std::int64_t offset_ns) const;
    std::optional<CameraAnchor> fit(std::int64_t index, const TriggerTimes &triggers) const;
    std::optional<CameraAnchor> only_fit(const TriggerTimes &triggers) const;
    void give_up();

    SweepTiming timing_;
    FrameNumbers numbers_;
    PlaneLabeller::Beginning beginning_ = PlaneLabeller::Beginning::FromRest;
    std::vector<CameraFrame> frames_;
    std::optional<CameraAnchor> before_;
    std::int64_t off_ns_ = 0;
    bool failed_ = false;
};

/* Labels frames whose triggers are seen: by the edges of a sync line, or because this host sends them.
 *
 * A frame has a label if its time, brought to the host's clock, is that of a trigger within a quarter of a
 * period; if its number is as many after the frame before it as its trigger is after that one's; and if it
 * arrived as long after its trigger as frames do. If not, the rest of its sweep has no label; from the next
 * sweep on labels come again, as soon as two frames arrived as long after their triggers as frames do.
 *
 * Where the triggers are counted by who gives them, that count must agree as well, and numbers are held
 * against it when the rhythm of the triggers is another than before. A count that contradicts the edges drops
 * the sweep, and those after it until it agrees again; if it does not for some sweeps, the triggers must
 * begin from rest. Without a count, or while it cannot be read, the others decide alone.
 *
 * The camera's clock is followed. It may run 200 ppm off the host's; after a silence in which that would have
 * grown to three eighths of a period it must be found anew. Where that, or a clock that was set, leaves more
 * than one answer, triggers that can begin from rest must.
 */
class TriggerLabeller : public PlaneLabeller {
public:
    /* The count may be null. Both outlive this object. */
    TriggerLabeller(const SweepTiming &timing, FrameNumbers numbers, TriggerTimes &triggers,
                    const TriggerCount *count = nullptr);

    void start(Beginning beginning, std::int64_t host_ns) override;
    FrameVerdict label(const CameraFrame &frame) override;
    bool lost() const override { return lost_; }
    const LabelCounts &counts() const override { return counts_; }

private:
    struct Placed {
        std::uint64_t id;
        std::int64_t index;
        unsigned rhythm;
        std::optional<std::int64_t> ordinal; /* of its trigger, where they are counted */
    };

    FrameVerdict seek(const CameraFrame &frame);
    FrameVerdict place(const CameraFrame &frame);
    Placed placed(const CameraFrame &frame, const Trigger &trigger) const;
    bool count_agrees() const;
    bool follows(const CameraFrame &frame, const Trigger &trigger) const;
    FrameVerdict place_untriggered(std::int64_t exposed_ns);
    FrameVerdict doubt(const CameraFrame &frame, const Trigger &trigger, std::uint64_t sweep);
    bool agrees(const CameraFrame &frame, std::int64_t exposed_ns, const Trigger &trigger);
    bool check_clock(const CameraFrame &frame);
    void follow(const CameraFrame &frame, const Trigger &trigger);

    SweepTiming timing_;
    FrameNumbers numbers_;
    TriggerTimes &triggers_;
    const TriggerCount *count_;
    LabelCounts counts_;
    FrameLedger ledger_{numbers_, counts_};
    AnchorSearch search_;
    std::optional<CameraAnchor> anchor_;
    std::optional<Placed> newest_;
    std::optional<std::int64_t> untriggered_ns_; /* when a frame was exposed that no trigger is known for */
    std::int64_t verified_ns_ = 0;               /* arrival of the last frame that agreed */
    unsigned disagreeing_ = 0;                   /* frames since then */
    unsigned unconfirmed_ = 0; /* frames that must yet arrive as they should, since the last doubt */
    bool anchor_broken_ = false;
    Beginning beginning_ = Beginning::FromRest;
    bool lost_ = false;
};

} // namespace dff
