/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "sweep_timing.h"
#include "trigger_times.h"

#include <cstdint>
#include <optional>

namespace dff {

/* How many triggers a sequencer says it has given, at some moment between the two. Its count began before us,
 * and wraps. Times are of the host's CLOCK_MONOTONIC. */
struct CountReading {
    std::uint32_t count;
    std::int64_t before_ns;
    std::int64_t after_ns;
};

/* The number of triggers that were sent: a witness beside the edges of the sync line. After a beginning from
 * rest the count alone says which plane the last trigger was of; that plane must be one of those which the
 * edges allow for the time of the reading. It agrees only if they allow no other, and not the last one: it is
 * best read half a period after an edge, and within half a period. While readings are slower, it says
 * nothing. */
class TriggerCount {
public:
    enum class Word {
        None,    /* it is not counted, or the count cannot be read */
        Awaited, /* it did not say anything yet in this rhythm of the triggers */
        Agrees,
        Contradicts
    };

    explicit TriggerCount(const SweepTiming &timing) : timing_(timing) {}

    /* The triggers rest, and the next one is plane 0. If the count is not known, there is no word until they
     * rest again. */
    void restart(std::optional<std::uint32_t> at_rest);

    /* The count was read. `triggers` is what the edges tell; null to count only. */
    void read(const CountReading &reading, const TriggerTimes *triggers);

    /* The count cannot be read now. */
    void withdraw();

    Word word(unsigned rhythm) const;

    /* How many triggers were given before this one since the rest; known where the count agrees. */
    std::optional<std::int64_t> ordinal(const Trigger &trigger, unsigned rhythm) const;

    /* Triggers given since the first rest. */
    std::uint64_t given() const { return given_; }

    /* Readings that contradict the edges; the last ones in a row. */
    std::uint64_t wrong() const { return wrong_; }
    unsigned wrong_in_a_row() const { return wrong_in_a_row_; }

private:
    /* Triggers that the last one given may be, by the edges. */
    struct Range {
        std::int64_t first;
        std::int64_t last;
    };

    std::optional<Range> possible(const CountReading &reading, const TriggerTimes &triggers) const;
    bool says_nothing(const CountReading &reading, const TriggerTimes &triggers);

    SweepTiming timing_;
    std::optional<std::uint32_t> count_; /* the sequencer's */
    std::uint64_t given_ = 0;
    std::uint64_t given_at_rest_ = 0;
    bool readable_ = false;
    std::optional<unsigned> rhythm_; /* in which it agreed last */
    std::int64_t offset_ = 0;        /* ordinal - index, there */
    std::uint64_t wrong_ = 0;
    unsigned wrong_in_a_row_ = 0;
};

} // namespace dff
