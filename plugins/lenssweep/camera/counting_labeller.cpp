/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "counting_labeller.h"

#include <cstdlib>

namespace dff {

CountingLabeller::CountingLabeller(const SweepTiming &timing, FrameNumbers numbers, Counts what)
    : timing_(timing), numbers_(numbers), what_(what)
{
}

void CountingLabeller::start(Beginning beginning, std::int64_t host_ns)
{
    rested_until_ns_ = beginning == Beginning::FromRest ? std::optional(host_ns) : std::nullopt;
    newest_.reset();
    ledger_.restart();
    lost_ = false;
}

bool CountingLabeller::is_first(const CameraFrame &frame) const
{
    return !rested_until_ns_ ||
           frame.arrival_ns - *rested_until_ns_ <= timing_.exposure_ns + timing_.period_ns * 7 / 8;
}

/* The sequencer's clock may be half a percent off. */
bool CountingLabeller::agrees(const CameraFrame &frame, std::int64_t index) const
{
    if (what_ == Counts::FreeRun)
        return true;
    const std::int64_t planes = timing_.planes;
    const std::int64_t sweeps = index / planes - newest_->index / planes;
    const std::int64_t periods = index % planes - newest_->index % planes;
    const std::int64_t expected_ns = sweeps * timing_.sweep_ns + periods * timing_.period_ns;
    const std::int64_t passed_ns = frame.stamp_ns() - newest_->frame.stamp_ns();
    return std::abs(passed_ns - expected_ns) <= timing_.tolerance_ns() + std::abs(expected_ns) / 200;
}

FrameVerdict CountingLabeller::give_up()
{
    counts_.disagreements++;
    lost_ = true;
    if (newest_)
        ledger_.drop_sweep(static_cast<std::uint64_t>(newest_->index / timing_.planes));
    return {std::nullopt, Unlabelled::Disagree};
}

FrameVerdict CountingLabeller::label(const CameraFrame &frame)
{
    FrameVerdict verdict;
    if (const auto reason = ledger_.enter(frame.id))
        verdict.reason = *reason;
    else if (!lost_)
        verdict = place(frame);
    (verdict.label ? counts_.labelled : counts_.unlabelled)++;
    return verdict;
}

FrameVerdict CountingLabeller::place(const CameraFrame &frame)
{
    if (!newest_ && !is_first(frame))
        return give_up();
    const std::int64_t index =
        newest_ ? newest_->index + numbers_.steps(newest_->frame.id, frame.id) : next_sweep_ * timing_.planes;
    if (newest_ && (index < 0 || !agrees(frame, index)))
        return give_up();
    if (!newest_ || index > newest_->index)
        newest_ = Placed{frame, index};
    next_sweep_ = newest_->index / timing_.planes + 1;
    return {FrameLabel{static_cast<std::uint64_t>(index / timing_.planes),
                       static_cast<unsigned>(index % timing_.planes), std::nullopt},
            {}};
}

} // namespace dff
