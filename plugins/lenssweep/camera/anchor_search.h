/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "plane_labeller.h"
#include "sweep_timing.h"
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
 * - a frame is here no sooner than its exposure ends, and, if nothing delays it, no later than one period
 * after that, since a camera that took longer could not keep up;
 * - after a beginning from rest, the first frame is of the first trigger.
 *
 * Where the triggers were under way already the first fact stands alone: then it must hold over three sweeps,
 * and with a margin at both ends.
 */
class AnchorSearch {
public:
    AnchorSearch(const SweepTiming &timing, FrameNumbers numbers) : timing_(timing), numbers_(numbers) {}

    void start(PlaneLabeller::Beginning beginning);

    /* A frame, and what is known of the triggers when it comes. */
    std::optional<CameraAnchor> add(const CameraFrame &frame, const TriggerTimes &triggers);

    /* Frames and triggers contradict each other; after a beginning from rest, for good. */
    bool failed() const { return failed_; }

private:
    std::size_t needed() const;
    std::optional<CameraAnchor> fit(std::int64_t index, const TriggerTimes &triggers) const;
    std::optional<CameraAnchor> only_fit(const TriggerTimes &triggers) const;
    void give_up();

    SweepTiming timing_;
    FrameNumbers numbers_;
    PlaneLabeller::Beginning beginning_ = PlaneLabeller::Beginning::FromRest;
    std::vector<CameraFrame> frames_;
    bool failed_ = false;
};

} // namespace dff
