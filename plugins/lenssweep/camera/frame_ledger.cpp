/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "frame_ledger.h"

#include <algorithm>

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

} // namespace dff
