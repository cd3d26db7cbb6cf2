/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "trigger_count.h"

namespace dff {

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
