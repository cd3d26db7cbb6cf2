/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <optional>

namespace dff {

/* A trigger that was given: index = sweep * planes + plane, by the host's CLOCK_MONOTONIC. */
struct Trigger {
    std::int64_t index;
    std::int64_t time_ns;
};

/* What the host knows of the triggers that were given. */
class TriggerTimes {
public:
    virtual ~TriggerTimes() = default;

    /* Forgets; indices go on rising. */
    virtual void restart() = 0;

    /* Changes when indices before and after the change have nothing to do with each other. */
    virtual unsigned rhythm() const = 0;

    /* The first trigger known since the restart; the first plane of a sweep. */
    virtual std::optional<Trigger> first() const = 0;

    /* Sweeps that were seen to begin when they should since the restart; 0 once anything contradicts that. */
    virtual unsigned proofs() const = 0;

    /* The trigger nearest to a time, if it is known to have been given. */
    virtual std::optional<Trigger> nearest(std::int64_t time_ns) const = 0;

    /* When a trigger was given, or would have been in the rhythm of those that are known. Call it only if
     * there is a first(). */
    virtual std::int64_t time_of(std::int64_t index) const = 0;
};

} // namespace dff
