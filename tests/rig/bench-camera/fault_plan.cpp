/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fault_plan.h"

#include <charconv>
#include <stdexcept>

namespace dff {

Frequency Frequency::parse(const std::string &text)
{
    Frequency frequency;
    frequency.by_chance = text.starts_with('~');
    const char *begin = text.data() + (frequency.by_chance ? 1 : 0);
    const char *end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(begin, end, frequency.one_in);
    if (error != std::errc() || rest != end || frequency.one_in == 0)
        throw std::invalid_argument("\"" + text +
                                    "\" is no frequency; use 100 for every hundredth, ~100 for one in a "
                                    "hundred by chance");
    return frequency;
}

bool FaultPlan::due(const Frequency &frequency)
{
    if (frequency.one_in == 0)
        return false;
    return frequency.by_chance ? random_() % frequency.one_in == 0 : count_ % frequency.one_in == 0;
}

Fault FaultPlan::next()
{
    count_++;
    return {due(settings_.ignore), due(settings_.lose), due(settings_.duplicate), due(settings_.reorder),
            due(settings_.delay)};
}

} // namespace dff
