/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "anchor_search.h"
#include "frame_ledger.h"
#include "plane_labeller.h"
#include "sweep_timing.h"
#include "trigger_count.h"
#include "trigger_times.h"

#include <optional>

namespace dff {

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
