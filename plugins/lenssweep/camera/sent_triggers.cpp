/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sent_triggers.h"

#include <algorithm>
#include <cstdlib>

namespace dff {

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

} // namespace dff
