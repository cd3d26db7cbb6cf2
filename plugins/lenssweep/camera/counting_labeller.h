/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "frame_ledger.h"
#include "plane_labeller.h"
#include "sweep_timing.h"

#include <optional>

namespace dff {

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

} // namespace dff
