/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "trigger_times.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace dff {

namespace {

constexpr std::size_t edges_kept = 16;
constexpr std::size_t edges_of_a_rhythm = 3;

std::int64_t rounded(std::int64_t value, std::int64_t unit)
{
    return (value >= 0 ? value + unit / 2 : value - unit / 2) / unit;
}

} // namespace

void SyncRhythm::restart()
{
    edges_.clear();
    first_.reset();
    doubted_ns_.clear();
    fitting_ = 0;
    contradicted_ = false;
    rhythm_++;
}

/* Empty if the two are not whole sweeps apart. The sequencer's clock and ours may differ by 200 ppm. */
std::optional<std::int64_t> SyncRhythm::sweeps_between(std::int64_t from_ns, std::int64_t to_ns) const
{
    const std::int64_t span_ns = to_ns - from_ns;
    const std::int64_t sweeps = rounded(span_ns, timing_.sweep_ns);
    if (std::abs(span_ns - sweeps * timing_.sweep_ns) > tolerance_ns())
        return std::nullopt;
    return sweeps;
}

bool SyncRhythm::believe(const Edge &edge)
{
    const auto later = std::find_if(edges_.begin(), edges_.end(),
                                    [&](const Edge &other) { return other.sweep >= edge.sweep; });
    if (later != edges_.end() && later->sweep == edge.sweep) {
        wrong_edges_++; /* doubled */
        return false;
    }
    edges_.insert(later, edge);
    if (edges_.size() > edges_kept)
        edges_.pop_front();
    next_sweep_ = std::max(next_sweep_, edge.sweep + 1);
    fitting_++;
    doubted_ns_.clear();
    if (!first_)
        first_ = Trigger{edge.sweep * timing_.planes, edge.time_ns};
    return true;
}

bool SyncRhythm::doubt(std::int64_t time_ns)
{
    wrong_edges_++;
    contradicted_ = true;
    if (!doubted_ns_.empty() && sweeps_between(doubted_ns_.back(), time_ns) != 1)
        doubted_ns_.clear();
    doubted_ns_.push_back(time_ns);
    if (doubted_ns_.size() < edges_of_a_rhythm)
        return false;
    const std::vector<std::int64_t> rhythm = std::exchange(doubted_ns_, {});
    restart();
    for (const std::int64_t edge_ns : rhythm)
        believe({next_sweep_, edge_ns});
    return true;
}

bool SyncRhythm::edge(std::int64_t time_ns)
{
    if (edges_.empty())
        return believe({next_sweep_, time_ns});
    const Edge &last = edges_.back();
    const auto sweeps = sweeps_between(last.time_ns, time_ns);
    return sweeps ? believe({last.sweep + *sweeps, time_ns}) : doubt(time_ns);
}

std::optional<Trigger> SyncRhythm::nearest(std::int64_t time_ns) const
{
    const auto later = std::find_if(edges_.begin(), edges_.end(), [&](const Edge &edge) {
        return edge.time_ns >= time_ns + timing_.period_ns / 2;
    });
    if (later == edges_.begin())
        return std::nullopt;
    const Edge &edge = *std::prev(later);
    const std::int64_t plane = rounded(time_ns - edge.time_ns, timing_.period_ns);
    if (plane >= timing_.planes)
        return std::nullopt;
    return Trigger{edge.sweep * timing_.planes + plane, edge.time_ns + plane * timing_.period_ns};
}

std::int64_t SyncRhythm::time_of(std::int64_t index) const
{
    const std::int64_t planes = timing_.planes;
    const std::int64_t plane = (index % planes + planes) % planes;
    const std::int64_t sweep = (index - plane) / planes;
    const Edge &nearest = *std::min_element(edges_.begin(), edges_.end(), [&](const Edge &a, const Edge &b) {
        return std::abs(a.sweep - sweep) < std::abs(b.sweep - sweep);
    });
    return nearest.time_ns + (sweep - nearest.sweep) * timing_.sweep_ns + plane * timing_.period_ns;
}

namespace {

constexpr std::size_t triggers_kept = 256;

} // namespace

void SentTriggers::restart()
{
    triggers_.clear();
    rhythm_++;
}

void SentTriggers::sent(const Trigger &trigger)
{
    triggers_.push_back(trigger);
    if (triggers_.size() > triggers_kept)
        triggers_.pop_front();
}

std::optional<Trigger> SentTriggers::first() const
{
    return triggers_.empty() ? std::nullopt : std::optional(triggers_.front());
}

std::optional<Trigger> SentTriggers::nearest(std::int64_t time_ns) const
{
    if (triggers_.empty())
        return std::nullopt;
    return *std::min_element(triggers_.begin(), triggers_.end(), [&](const Trigger &a, const Trigger &b) {
        return std::abs(a.time_ns - time_ns) < std::abs(b.time_ns - time_ns);
    });
}

std::int64_t SentTriggers::time_of(std::int64_t index) const
{
    const auto found = std::find_if(triggers_.begin(), triggers_.end(),
                                    [&](const Trigger &trigger) { return trigger.index == index; });
    if (found != triggers_.end())
        return found->time_ns;
    const Trigger &first = triggers_.front();
    return first.time_ns + (index - first.index) * timing_.period_ns;
}

void TriggerCount::restart(std::optional<std::uint32_t> at_rest)
{
    count_ = at_rest;
    given_at_rest_ = given_;
    readable_ = at_rest.has_value();
    rhythm_.reset();
    wrong_in_a_row_ = 0;
}

std::optional<TriggerCount::Range> TriggerCount::possible(const CountReading &reading,
                                                          const TriggerTimes &triggers) const
{
    const std::int64_t tolerance_ns = timing_.tolerance_ns();
    const auto at_first = triggers.nearest(reading.before_ns);
    const auto at_last = triggers.nearest(reading.after_ns);
    if (!at_first || !at_last)
        return std::nullopt;
    const bool given_before = at_first->time_ns + tolerance_ns <= reading.before_ns;
    const bool given_after = at_last->time_ns - tolerance_ns <= reading.after_ns;
    return Range{at_first->index - (given_before ? 0 : 1), at_last->index - (given_after ? 0 : 1)};
}

/* What contradicted and cannot say that it agrees again goes on to contradict. */
void TriggerCount::withdraw()
{
    readable_ = wrong_in_a_row_ > 0;
    if (readable_)
        wrong_in_a_row_++;
}

/* Of a reading that leaves it open; else takes down what it says. */
bool TriggerCount::says_nothing(const CountReading &reading, const TriggerTimes &triggers)
{
    const auto range = possible(reading, triggers);
    if (!range)
        return true;
    const std::int64_t planes = timing_.planes;
    const auto last = static_cast<std::int64_t>(given_ - given_at_rest_) - 1;
    const std::int64_t beyond = ((last - range->first) % planes + planes) % planes;
    if (range->first + beyond > range->last) {
        wrong_++;
        wrong_in_a_row_++;
        return false;
    }
    /* After the last plane the count may rest while the lens goes back, and does not tell since when. */
    if (range->first != range->last || (range->last + 1) % planes == 0)
        return true;
    rhythm_ = triggers.rhythm();
    offset_ = last - range->first;
    wrong_in_a_row_ = 0;
    return false;
}

void TriggerCount::read(const CountReading &reading, const TriggerTimes *triggers)
{
    if (!count_)
        return;
    given_ += static_cast<std::uint32_t>(reading.count - *count_);
    count_ = reading.count;
    if (!triggers)
        return;
    const bool quick = reading.after_ns - reading.before_ns < timing_.period_ns / 2;
    if (!says_nothing(reading, *triggers) || quick)
        readable_ = true;
    else if (word(triggers->rhythm()) != Word::Agrees)
        withdraw();
}

TriggerCount::Word TriggerCount::word(unsigned rhythm) const
{
    if (!count_ || !readable_)
        return Word::None;
    if (wrong_in_a_row_ > 0)
        return Word::Contradicts;
    return rhythm_ == rhythm ? Word::Agrees : Word::Awaited;
}

std::optional<std::int64_t> TriggerCount::ordinal(const Trigger &trigger, unsigned rhythm) const
{
    return word(rhythm) == Word::Agrees ? std::optional(trigger.index + offset_) : std::nullopt;
}

} // namespace dff
