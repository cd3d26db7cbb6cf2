/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace dff {

/* A sweep as the triggers give it. Times are nanoseconds. */
struct SweepTiming {
    unsigned planes = 0;
    std::int64_t period_ns = 0; /* from one exposure to the next within a sweep */
    std::int64_t sweep_ns = 0;  /* from plane 0 to plane 0: the planes' periods and the lens's way back */
    std::int64_t exposure_ns = 0;
    std::int64_t transfer_ns = 0; /* what the link needs for a frame at the least; 0: not known */

    /* How far two clocks may differ about a trigger and still agree. */
    std::int64_t tolerance_ns() const { return period_ns / 4; }
};

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

/* The triggers that the sync line tells of: each edge is plane 0 of a sweep, and edges come one sweep apart.
 * An edge that is doubled or out of this rhythm is counted and not believed; three in a row that are one
 * sweep apart begin a new rhythm. Edges that are missing make their sweep unknown, and do no more harm. */
class SyncRhythm : public TriggerTimes {
public:
    explicit SyncRhythm(const SweepTiming &timing) : timing_(timing) {}

    /* Whether the edge is believed. Edges may come late and out of order. */
    bool edge(std::int64_t time_ns);

    std::uint64_t wrong_edges() const { return wrong_edges_; }

    void restart() override;
    unsigned rhythm() const override { return rhythm_; }
    std::optional<Trigger> first() const override { return first_; }
    unsigned proofs() const override { return contradicted_ ? 0 : fitting_; }
    std::optional<Trigger> nearest(std::int64_t time_ns) const override;
    std::int64_t time_of(std::int64_t index) const override;

private:
    struct Edge {
        std::int64_t sweep;
        std::int64_t time_ns;
    };

    std::int64_t tolerance_ns() const { return timing_.period_ns / 8; }
    std::optional<std::int64_t> sweeps_between(std::int64_t from_ns, std::int64_t to_ns) const;
    bool believe(const Edge &edge);
    bool doubt(std::int64_t time_ns);

    SweepTiming timing_;
    std::deque<Edge> edges_; /* believed, in order of time, the last few */
    std::int64_t next_sweep_ = 0;
    std::optional<Trigger> first_;
    std::vector<std::int64_t>
        doubted_ns_;       /* edges out of the rhythm, but a sweep apart; none in it came since */
    unsigned fitting_ = 0; /* edges believed since the restart */
    bool contradicted_ = false;
    std::uint64_t wrong_edges_ = 0;
    unsigned rhythm_ = 0;
};

/* The triggers that this host sends itself, one plane after the other. */
class SentTriggers : public TriggerTimes {
public:
    explicit SentTriggers(const SweepTiming &timing) : timing_(timing) {}

    /* A trigger is given now. The index says which. */
    void sent(const Trigger &trigger);

    void restart() override;
    unsigned rhythm() const override { return rhythm_; }
    std::optional<Trigger> first() const override;
    unsigned proofs() const override { return static_cast<unsigned>(triggers_.size()); }
    std::optional<Trigger> nearest(std::int64_t time_ns) const override;
    std::int64_t time_of(std::int64_t index) const override;

private:
    SweepTiming timing_;
    std::deque<Trigger> triggers_; /* in order, the last few */
    unsigned rhythm_ = 0;
};

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
