/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "step_tagger.h"

#include <chrono>

namespace {

/* std::chrono's steady clock is CLOCK_MONOTONIC on Linux. */
uint64_t now_ns()
{
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

} // namespace

StepTagger::StepTagger(std::unique_ptr<dff::SteppedLens> lens, unsigned planes, unsigned settle_frames)
    : lens_(std::move(lens)), planes_(planes), settle_frames_(settle_frames)
{
}

void StepTagger::restart()
{
    if (next_.plane > 0)
        next_ = {next_.sweep + 1, 0};
    positioned_ = false;
}

/* Begins to rest at the next plane, unless interrupted. */
void StepTagger::position(const std::stop_token &stop)
{
    lens_->move_to(next_.plane);
    positioned_ = lens_->wait_settled(stop);
    rests_since_ns_ = now_ns();
    rested_frames_ = 0;
}

std::optional<PlaneLabel> StepTagger::label(std::optional<uint64_t> time_ns, const std::stop_token &stop)
{
    if (!positioned_)
        position(stop);
    const bool moved = time_ns && *time_ns < rests_since_ns_ + period_ns_;
    if (!positioned_ || moved || ++rested_frames_ <= settle_frames_)
        return std::nullopt;
    const PlaneLabel label = next_;
    next_ =
        label.plane + 1 < planes_ ? PlaneLabel{label.sweep, label.plane + 1} : PlaneLabel{label.sweep + 1, 0};
    position(stop);
    return label;
}
