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

} // namespace dff
