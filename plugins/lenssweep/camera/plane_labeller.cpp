/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "plane_labeller.h"

#include <algorithm>
#include <cstdlib>

namespace dff {

const char *name_of(Unlabelled reason)
{
    switch (reason) {
    case Unlabelled::Seeking:
        return "not yet known which trigger is which frame's";
    case Unlabelled::Invalid:
        return "not a number of a frame";
    case Unlabelled::Doubled:
        return "here already";
    case Unlabelled::NoTrigger:
        return "no trigger known that it could be of";
    case Unlabelled::Disagree:
        return "its number, its time and the triggers disagree";
    case Unlabelled::Incomplete:
        return "packets missing";
    }
    return "";
}

void FrameLedger::restart()
{
    recent_.fill(std::nullopt);
    newest_.reset();
}

bool FrameLedger::seen(std::uint64_t id) const
{
    return std::find(recent_.begin(), recent_.end(), std::optional(id)) != recent_.end();
}

std::optional<Unlabelled> FrameLedger::enter(std::uint64_t id)
{
    if (!numbers_.valid(id))
        return Unlabelled::Invalid;
    if (seen(id)) {
        counts_.doubled++;
        return Unlabelled::Doubled;
    }
    recent_.at(next_) = id;
    next_ = (next_ + 1) % recent_.size();
    const std::int64_t steps = newest_ ? numbers_.steps(*newest_, id) : 1;
    if (steps > 0) {
        counts_.lost += static_cast<std::uint64_t>(steps - 1);
        newest_ = id;
    } else if (counts_.lost > 0) {
        counts_.lost--; /* late, not lost */
    }
    return std::nullopt;
}

void FrameLedger::drop_sweep(std::uint64_t sweep)
{
    if (dropped_ != sweep)
        counts_.dropped_sweeps++;
    dropped_ = sweep;
}

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

namespace {

/* More than it takes to find out which trigger is which frame's, be it twice. */
constexpr unsigned sweeps_without_label = 20;
constexpr unsigned dropped_in_a_row = 10;

const char *what_to_check(Unlabelled reason)
{
    switch (reason) {
    case Unlabelled::Incomplete:
        return "packets of them are missing. Check that the network takes packets of this size (MTU), that "
               "the "
               "link is fast enough and carries nothing else, and that this machine keeps up";
    case Unlabelled::Invalid:
        return "the camera numbers them in a way that is not known here";
    case Unlabelled::Doubled:
        return "the camera gives the same number again and again";
    case Unlabelled::NoTrigger:
        return "no edge of sync-line came with them. Check that it is wired, and that the sequencer pulses "
               "it at "
               "plane 0 of each sweep";
    case Unlabelled::Seeking:
    case Unlabelled::Disagree:
        break;
    }
    return "they do not fit the triggers. Check that planes and rate are those of the sequencer, and that "
           "the "
           "camera takes every trigger (exposure, TriggerOverlap). One that heeds no trigger, as most "
           "simulated "
           "cameras, needs trigger=free-run";
}

} // namespace

void LabelWatch::labelled(const FrameLabel &label)
{
    unlabelled_in_row_ = 0;
    labels_ = label.sweep == sweep_ ? labels_ + 1 : 1;
    sweep_ = label.sweep;
    if (labels_ < planes_)
        return;
    reasons_.fill(0);
    dropped_in_row_ = 0;
}

void LabelWatch::judged(const FrameVerdict &verdict, std::uint64_t dropped_sweeps)
{
    dropped_in_row_ += static_cast<unsigned>(dropped_sweeps - std::exchange(dropped_sweeps_, dropped_sweeps));
    if (verdict.label)
        return labelled(*verdict.label);
    reasons_.at(static_cast<std::size_t>(verdict.reason))++;
    unlabelled_in_row_++;
    if (unlabelled_in_row_ == sweeps_without_label * planes_)
        complain("The planes of the last " + std::to_string(unlabelled_in_row_) + " frames cannot be told");
    else if (dropped_in_row_ >= dropped_in_a_row)
        complain("Some planes of each of the last " + std::to_string(dropped_in_row_) +
                 " sweeps cannot be told");
}

Unlabelled LabelWatch::main_reason() const
{
    const auto most = std::max_element(reasons_.begin(), reasons_.end());
    return static_cast<Unlabelled>(most - reasons_.begin());
}

void LabelWatch::complain(const std::string &what)
{
    dropped_in_row_ = 0;
    const Unlabelled reason = main_reason();
    if (told_.insert(reason).second)
        complaint_ = what + ": " + what_to_check(reason) + ". The frames are dropped; stats counts them.";
}

} // namespace dff
