/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "trigger_labeller.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace dff {

void AnchorSearch::start(PlaneLabeller::Beginning beginning)
{
    beginning_ = beginning;
    frames_.clear();
    before_.reset();
    failed_ = false;
}

void AnchorSearch::resume(const CameraAnchor &before, std::int64_t off_ns)
{
    start(PlaneLabeller::Beginning::UnderWay);
    before_ = before;
    off_ns_ = off_ns;
}

bool AnchorSearch::near_the_one_before(std::int64_t offset_ns) const
{
    return !before_ || std::abs(offset_ns - before_->offset_ns) <= off_ns_ + timing_.period_ns / 16;
}

std::size_t AnchorSearch::needed() const
{
    return beginning_ == PlaneLabeller::Beginning::FromRest ? timing_.planes
                                                            : 3 * std::size_t{timing_.planes};
}

std::size_t AnchorSearch::most() const
{
    return beginning_ == PlaneLabeller::Beginning::FromRest ? 8 * needed() : 2 * needed();
}

/* What follows if the first frame, by its number, is of this trigger; nothing if that cannot be. */
std::optional<CameraAnchor> AnchorSearch::fit(std::int64_t index, const TriggerTimes &triggers) const
{
    const std::uint64_t first_id = std::min_element(frames_.begin(), frames_.end(), [this](auto &a, auto &b) {
                                       return numbers_.steps(a.id, b.id) > 0;
                                   })->id;
    std::int64_t latency_ns = std::numeric_limits<std::int64_t>::max();
    std::int64_t least_ns = std::numeric_limits<std::int64_t>::max();
    std::int64_t most_ns = std::numeric_limits<std::int64_t>::min();
    for (const CameraFrame &frame : frames_) {
        const std::int64_t steps = numbers_.steps(first_id, frame.id);
        const std::int64_t trigger_ns = triggers.time_of(index + steps);
        latency_ns = std::min(latency_ns, frame.arrival_ns - trigger_ns);
        least_ns = std::min(least_ns, frame.camera_ns - trigger_ns);
        most_ns = std::max(most_ns, frame.camera_ns - trigger_ns);
    }
    const bool from_rest = beginning_ == PlaneLabeller::Beginning::FromRest;
    const std::int64_t margin_ns = from_rest ? -timing_.period_ns / 8 : timing_.period_ns / 32;
    const std::int64_t transfer_ns = latency_ns - timing_.exposure_ns - timing_.transfer_ns;
    if (transfer_ns < margin_ns || transfer_ns > timing_.period_ns - timing_.period_ns / (from_rest ? 8 : 32))
        return std::nullopt;
    const std::int64_t last_index = index + numbers_.steps(first_id, frames_.back().id);
    if (frames_.front().camera_ns == 0)
        return CameraAnchor{latency_ns, latency_ns, last_index};
    const std::int64_t offset_ns = least_ns + (most_ns - least_ns) / 2;
    if (most_ns - least_ns > timing_.tolerance_ns() || !near_the_one_before(offset_ns))
        return std::nullopt;
    return CameraAnchor{offset_ns, latency_ns, last_index};
}

std::optional<CameraAnchor> AnchorSearch::only_fit(const TriggerTimes &triggers) const
{
    const std::int64_t first = triggers.first()->index;
    if (beginning_ == PlaneLabeller::Beginning::FromRest)
        return fit(first, triggers);
    const std::int64_t reach = 4 * std::int64_t{timing_.planes};
    std::optional<CameraAnchor> found;
    for (std::int64_t index = first - reach; index <= first + reach; index++) {
        const auto anchor = fit(index, triggers);
        if (anchor && found)
            return std::nullopt;
        if (anchor)
            found = anchor;
    }
    return found;
}

void AnchorSearch::give_up()
{
    frames_.clear();
    failed_ = true;
}

std::optional<CameraAnchor> AnchorSearch::add(const CameraFrame &frame, const TriggerTimes &triggers)
{
    if (failed_ && beginning_ == PlaneLabeller::Beginning::FromRest)
        return std::nullopt;
    frames_.push_back(frame);
    if (frames_.size() < needed())
        return std::nullopt;
    const unsigned proofs = beginning_ == PlaneLabeller::Beginning::FromRest ? 2 : 3;
    const bool possible = triggers.first() && triggers.proofs() >= proofs;
    const auto anchor = possible ? only_fit(triggers) : std::nullopt;
    if (anchor)
        failed_ = false;
    else if (frames_.size() >= most() || (possible && beginning_ == PlaneLabeller::Beginning::UnderWay))
        give_up();
    return anchor;
}

namespace {

constexpr std::int64_t drift_ppm = 200;

/* One may be late by just what a clock jumped. */
constexpr unsigned frames_to_confirm = 2;

/* Readings of the count, one a sweep, after which waiting is of no use. */
constexpr unsigned wrong_counts_to_give_up = 3;

} // namespace

TriggerLabeller::TriggerLabeller(const SweepTiming &timing, FrameNumbers numbers, TriggerTimes &triggers,
                                 const TriggerCount *count)
    : timing_(timing), numbers_(numbers), triggers_(triggers), count_(count), search_(timing, numbers)
{
}

void TriggerLabeller::start(Beginning beginning, std::int64_t)
{
    beginning_ = beginning;
    triggers_.restart();
    search_.start(beginning);
    anchor_.reset();
    newest_.reset();
    ledger_.restart();
    lost_ = false;
}

FrameVerdict TriggerLabeller::label(const CameraFrame &frame)
{
    FrameVerdict verdict;
    if (count_ && count_->wrong_in_a_row() >= wrong_counts_to_give_up)
        lost_ = true;
    if (const auto reason = ledger_.enter(frame.id))
        verdict.reason = *reason;
    else
        verdict = anchor_ && check_clock(frame) ? place(frame) : seek(frame);
    (verdict.label ? counts_.labelled : counts_.unlabelled)++;
    return verdict;
}

FrameVerdict TriggerLabeller::seek(const CameraFrame &frame)
{
    if (lost_)
        return {std::nullopt, Unlabelled::Seeking};
    anchor_ = search_.add(frame, triggers_);
    lost_ = search_.failed();
    if (anchor_) {
        newest_ = placed(frame, {anchor_->index, triggers_.time_of(anchor_->index)});
        verified_ns_ = frame.arrival_ns;
        disagreeing_ = 0;
        unconfirmed_ = 0;
        anchor_broken_ = false;
    }
    return {std::nullopt, Unlabelled::Seeking};
}

/* Whether the anchor can still be used. A camera without a clock has nothing but numbers to rely on, which a
 * new rhythm of the triggers makes worthless. */
bool TriggerLabeller::check_clock(const CameraFrame &frame)
{
    const std::int64_t off_ns = (frame.arrival_ns - verified_ns_) / 1'000'000 * drift_ppm;
    if (off_ns > timing_.period_ns / 8)
        unconfirmed_ = std::max(unconfirmed_, 1U);
    const bool out_of_reach = frame.camera_ns == 0 && newest_->rhythm != triggers_.rhythm();
    const bool useless = disagreeing_ >= 3 * timing_.planes || anchor_broken_ || out_of_reach;
    if (off_ns <= timing_.period_ns * 3 / 8 && !useless)
        return true;
    const bool near = !useless && frame.camera_ns != 0 && off_ns < timing_.period_ns * 7 / 16;
    if (near)
        search_.resume(*anchor_, off_ns);
    else if (beginning_ == Beginning::FromRest)
        lost_ = true;
    else
        search_.start(Beginning::UnderWay);
    anchor_.reset();
    return false;
}

void TriggerLabeller::follow(const CameraFrame &frame, const Trigger &trigger)
{
    anchor_->offset_ns += (frame.stamp_ns() - anchor_->offset_ns - trigger.time_ns) / 8;
    anchor_->latency_ns = std::min(anchor_->latency_ns, frame.arrival_ns - trigger.time_ns);
    verified_ns_ = frame.arrival_ns;
    disagreeing_ = 0;
}

/* The edge of its sweep is missing, or late: then what comes of the sweep after it has no label either. */
FrameVerdict TriggerLabeller::place_untriggered(std::int64_t exposed_ns)
{
    if (!untriggered_ns_ || exposed_ns - *untriggered_ns_ > timing_.sweep_ns)
        counts_.dropped_sweeps++;
    untriggered_ns_ = exposed_ns;
    return {std::nullopt, Unlabelled::NoTrigger};
}

/* Without a clock of the camera's, a frame that is late looks like one of a later trigger, and the numbers
 * are what can be relied on. With one, the time is; that the clock did not jump is then to be confirmed. */
FrameVerdict TriggerLabeller::doubt(const CameraFrame &frame, const Trigger &trigger, std::uint64_t sweep)
{
    disagreeing_++;
    if (frame.camera_ns != 0)
        newest_ = placed(frame, trigger);
    ledger_.drop_sweep(sweep);
    return {std::nullopt, Unlabelled::Disagree};
}

TriggerLabeller::Placed TriggerLabeller::placed(const CameraFrame &frame, const Trigger &trigger) const
{
    const unsigned rhythm = triggers_.rhythm();
    return {frame.id, trigger.index, rhythm, count_ ? count_->ordinal(trigger, rhythm) : std::nullopt};
}

bool TriggerLabeller::count_agrees() const
{
    if (!count_)
        return true;
    const auto word = count_->word(triggers_.rhythm());
    return word == TriggerCount::Word::Agrees || word == TriggerCount::Word::None;
}

/* Whether the number is as many after the newest one's as the trigger is. In another rhythm only the count
 * tells how many those are. */
bool TriggerLabeller::follows(const CameraFrame &frame, const Trigger &trigger) const
{
    const Placed now = placed(frame, trigger);
    if (now.ordinal && newest_->ordinal)
        return numbers_.apart(newest_->id, now.id, *now.ordinal - *newest_->ordinal);
    if (now.rhythm != newest_->rhythm)
        return !now.ordinal; /* it could be told, and was not yet */
    return numbers_.apart(newest_->id, now.id, now.index - newest_->index);
}

bool TriggerLabeller::agrees(const CameraFrame &frame, std::int64_t exposed_ns, const Trigger &trigger)
{
    const bool timely = std::abs(exposed_ns - trigger.time_ns) <= timing_.tolerance_ns();
    if (!timely || !follows(frame, trigger)) {
        counts_.disagreements++;
        unconfirmed_ = frames_to_confirm;
        return false;
    }
    const std::int64_t latency_ns = frame.arrival_ns - trigger.time_ns;
    const std::int64_t delay_ns = latency_ns - anchor_->latency_ns;
    const bool possible = latency_ns >= timing_.exposure_ns + timing_.transfer_ns - timing_.period_ns / 8;
    const bool settled = unconfirmed_ == 0 && newest_->rhythm == triggers_.rhythm();
    if (delay_ns < -timing_.tolerance_ns() && !(possible && settled)) {
        anchor_broken_ = true; /* it is here before its time, or a clock in doubt says so: the clock jumped */
        return false;
    }
    if (unconfirmed_ > 0 && delay_ns <= timing_.tolerance_ns())
        unconfirmed_--;
    return unconfirmed_ == 0;
}

FrameVerdict TriggerLabeller::place(const CameraFrame &frame)
{
    const std::int64_t exposed_ns = frame.stamp_ns() - anchor_->offset_ns;
    const auto trigger = triggers_.nearest(exposed_ns);
    if (!trigger)
        return place_untriggered(exposed_ns);
    const auto sweep = static_cast<std::uint64_t>(trigger->index / timing_.planes);
    const auto plane = static_cast<unsigned>(trigger->index % timing_.planes);
    if (!count_agrees()) {
        ledger_.drop_sweep(sweep);
        return {std::nullopt, Unlabelled::Disagree};
    }
    if (!agrees(frame, exposed_ns, *trigger))
        return doubt(frame, *trigger, sweep);

    follow(frame, *trigger);
    if (newest_->rhythm != triggers_.rhythm() || trigger->index > newest_->index)
        newest_ = placed(frame, *trigger);
    const std::int64_t begin_ns = trigger->time_ns - plane * timing_.period_ns;
    if (untriggered_ns_ && std::abs(begin_ns - *untriggered_ns_) < timing_.sweep_ns &&
        *untriggered_ns_ > begin_ns - timing_.tolerance_ns())
        ledger_.drop_sweep(sweep);
    untriggered_ns_.reset();
    if (ledger_.dropped(sweep))
        return {std::nullopt, Unlabelled::Disagree};
    return {FrameLabel{sweep, plane, trigger->time_ns}, {}};
}

} // namespace dff
