/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* The number of triggers that the sequencer sent, as a witness of its sync line. */
#include "label_bench.h"

using dff::TriggerCount;
using Word = dff::TriggerCount::Word;

namespace {

constexpr std::int64_t begin = 1'000'000'000;

/* Two sweeps of the paper's rig; the count was 1000 at rest. */
struct Count {
    Count()
    {
        for (int sweep = 0; sweep < 2; sweep++)
            rhythm.edge(begin + sweep * 6 * period);
        count.restart(1000);
    }

    /* Reads it so many periods after the first trigger. */
    Word read(std::uint32_t given, double at, double lasts = 0)
    {
        const auto time_ns = begin + static_cast<std::int64_t>(at * period);
        count.read({1000 + given, time_ns, time_ns + static_cast<std::int64_t>(lasts * period)}, &rhythm);
        return count.word(rhythm.rhythm());
    }

    dff::SweepTiming timing = paper_rig().timing;
    dff::SyncRhythm rhythm{timing};
    TriggerCount count{timing};
};

} // namespace

TEST(TriggerCount, agrees_if_the_plane_is_the_one_of_the_edges)
{
    EXPECT_EQ(Count().read(1, 0.5), Word::Agrees);
    EXPECT_EQ(Count().read(3, 2.5), Word::Agrees);
    EXPECT_EQ(Count().read(7, 6.5), Word::Agrees);
    EXPECT_EQ(Count().read(13, 6.5), Word::Agrees) << "as many edges were missed";
    EXPECT_EQ(Count().read(2, 0.5), Word::Contradicts);
    EXPECT_EQ(Count().read(6, 6.5), Word::Contradicts);
}

TEST(TriggerCount, waits_where_a_reading_leaves_it_open)
{
    EXPECT_EQ(Count().count.word(0), Word::Awaited);
    EXPECT_EQ(Count().read(1, 0.1), Word::Awaited) << "a trigger is too near";
    EXPECT_EQ(Count().read(6, 6.1), Word::Awaited);
    EXPECT_EQ(Count().read(2, 0.9), Word::Awaited);
    EXPECT_EQ(Count().read(6, 5.3), Word::Awaited) << "the lens may be on its way back";
}

TEST(TriggerCount, says_nothing_while_the_bus_is_slow)
{
    Count slow;
    EXPECT_EQ(slow.read(2, 0.5, 1.5), Word::None);
    EXPECT_EQ(slow.read(4, 0.5, 1.5), Word::Contradicts) << "that much it can say";
    EXPECT_EQ(slow.read(8, 6.5, 1.5), Word::Contradicts);
    EXPECT_EQ(slow.count.wrong_in_a_row(), 2U) << "nor does it take that back";
    EXPECT_EQ(slow.read(13, 6.5), Word::Agrees);
    EXPECT_EQ(slow.read(14, 6.5, 1.5), Word::Agrees);
}

TEST(TriggerCount, withdraws_while_it_cannot_be_read)
{
    Count count;
    count.count.withdraw();
    EXPECT_EQ(count.count.word(0), Word::None);
    EXPECT_EQ(count.read(1, 0.5), Word::Agrees);
    EXPECT_EQ(count.read(5, 6.5), Word::Contradicts);
    count.count.withdraw();
    EXPECT_EQ(count.count.word(0), Word::Contradicts) << "what contradicts does not fall silent";
    EXPECT_EQ(count.count.wrong_in_a_row(), 2U);
    count.count.restart(std::nullopt);
    EXPECT_EQ(count.read(1, 0.5), Word::None);
}

TEST(CountedSyncLine, a_count_that_agrees_costs_no_label)
{
    Bench bench(10);
    bench.count_triggers();
    EXPECT_EQ(bench.run().size(), 9U * 6U);
    EXPECT_EQ(bench.count.wrong(), 0U);
    EXPECT_EQ(bench.labeller.counts().dropped_sweeps, 0U);
}

TEST(CountedSyncLine, sweeps_are_dropped_from_a_contradiction_until_it_agrees)
{
    Bench bench(10);
    bench.count_triggers();
    const std::int64_t sweep_4 = begin + 4 * 6 * period;
    const auto right = bench.read_count;
    bench.read_count = [&](std::int64_t time_ns) {
        const bool wrong = time_ns > sweep_4 && time_ns < sweep_4 + 2 * 6 * period;
        wrong ? bench.count.read({bench.given(time_ns) + 1, time_ns, time_ns}, &bench.rhythm)
              : right(time_ns);
    };
    EXPECT_EQ(bench.run().size(), (9U - 2U) * 6U);
    EXPECT_EQ(bench.count.wrong(), 2U);
    EXPECT_EQ(bench.labeller.counts().dropped_sweeps, 2U);
    EXPECT_FALSE(bench.labeller.lost());
}

TEST(CountedSyncLine, a_trigger_that_was_not_given_needs_a_start_from_rest)
{
    Bench bench(10);
    bench.count_triggers();
    bench.rig.triggers_ns.erase(bench.rig.triggers_ns.begin() + 3 * 6 + 2);
    EXPECT_EQ(bench.run().size(), 3U * 6U);
    EXPECT_TRUE(bench.labeller.lost());
    EXPECT_EQ(bench.count.wrong(), 6U);
}

TEST(CountedSyncLine, ten_seconds_without_triggers_cost_two_sweeps)
{
    Bench bench(20);
    bench.pause_before(8, 10'003'000'000, 0);
    bench.count_triggers();
    EXPECT_EQ(bench.run().size(), (20U - 1U - 2U) * 6U);
}

TEST(CountedSyncLine, edges_at_another_plane_give_no_labels)
{
    Bench bench(20);
    for (RigEvent &event : bench.events)
        if (event.kind == RigEvent::Edge && event.time_ns > begin + 8 * 6 * period)
            event.time_ns += 2 * period;
    bench.count_triggers();
    EXPECT_EQ(bench.run().size(), (8U - 1U) * 6U);
    EXPECT_TRUE(bench.labeller.lost());
}
