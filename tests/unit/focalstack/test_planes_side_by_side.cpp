/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/frame_numbering.h"
#include "focalstack/sweep_gate.h"

#include <chrono>
#include <future>
#include <gtest/gtest.h>

using dff::FrameNumbering;
using dff::GatePass;
using dff::SweepGate;
using namespace std::chrono_literals;

TEST(FrameNumbering, a_lost_frame_leaves_a_gap)
{
    FrameNumbering numbering;
    EXPECT_EQ(numbering.next(1000, 100, 1000), 0u);
    EXPECT_EQ(numbering.next(1101, 100, 1000), 1u);
    EXPECT_EQ(numbering.next(1302, 100, 1000), 3u);
}

TEST(FrameNumbering, a_source_that_starts_later_is_numbered_by_its_time)
{
    FrameNumbering numbering;
    EXPECT_EQ(numbering.next(1260, 100, 1000), 3u);
    EXPECT_EQ(numbering.next(1340, 100, 1000), 4u);
}

TEST(FrameNumbering, a_clock_that_drifts_skips_no_sweep)
{
    FrameNumbering numbering;
    uint64_t sweep = 0;
    for (uint64_t k = 0; k < 1000; k++)
        sweep = numbering.next(k * 103, 100, 0);
    EXPECT_EQ(sweep, 999u);
}

TEST(FrameNumbering, without_times_frames_are_counted)
{
    FrameNumbering numbering;
    EXPECT_EQ(numbering.next(std::nullopt, 0, 0), 0u);
    EXPECT_EQ(numbering.next(std::nullopt, 100, 0), 1u);
}

/* With two sources, 0 and 1. */
class TwoSources : public testing::Test {
protected:
    TwoSources()
    {
        gate.open(0);
        gate.open(1);
    }

    std::future<GatePass> wait(unsigned plane, uint64_t lead = 1)
    {
        return std::async(std::launch::async, [this, plane, lead] { return gate.enter(plane, lead); });
    }

    SweepGate gate;
};

TEST_F(TwoSources, a_fast_source_waits_for_a_slow_one)
{
    gate.arrive(1, 0);
    gate.arrive(0, 2);
    auto fast = wait(0);
    EXPECT_EQ(fast.wait_for(50ms), std::future_status::timeout);
    gate.arrive(1, 1);
    EXPECT_EQ(fast.wait_for(5s), std::future_status::ready);
    EXPECT_EQ(fast.get(), GatePass::Through);
}

TEST_F(TwoSources, nobody_waits_for_a_source_that_ended)
{
    gate.arrive(0, 7);
    auto other = wait(0);
    gate.close(1);
    ASSERT_EQ(other.wait_for(5s), std::future_status::ready);
    EXPECT_EQ(other.get(), GatePass::Through);
}

TEST_F(TwoSources, shutting_wakes_who_waits)
{
    gate.arrive(0, 1);
    auto waiting = wait(0);
    gate.shut();
    ASSERT_EQ(waiting.wait_for(5s), std::future_status::ready);
    EXPECT_EQ(waiting.get(), GatePass::Shut);
}

TEST_F(TwoSources, a_source_that_is_taken_away_does_not_wait)
{
    gate.arrive(0, 5);
    auto waiting = wait(0);
    gate.close(0);
    ASSERT_EQ(waiting.wait_for(5s), std::future_status::ready);
    EXPECT_EQ(waiting.get(), GatePass::Closed);
}

TEST_F(TwoSources, one_that_is_flushed_does_not_wake_the_other)
{
    gate.arrive(0, 5);
    auto other = wait(0);
    gate.arrive(1, 2);
    auto flushed = wait(1);
    ASSERT_EQ(flushed.wait_for(5s), std::future_status::ready);
    EXPECT_EQ(flushed.get(), GatePass::Through);
    gate.shut(1);
    gate.leave();
    EXPECT_EQ(gate.enter(1, 1), GatePass::Shut);
    EXPECT_EQ(other.wait_for(50ms), std::future_status::timeout);
    gate.open(1);
    gate.arrive(1, 4);
    ASSERT_EQ(other.wait_for(5s), std::future_status::ready);
    EXPECT_EQ(other.get(), GatePass::Through);
}

TEST_F(TwoSources, one_is_in_at_a_time)
{
    gate.arrive(0, 1);
    gate.arrive(1, 1);
    EXPECT_EQ(gate.enter(0, 1), GatePass::Through);
    auto next = wait(1);
    EXPECT_EQ(next.wait_for(50ms), std::future_status::timeout);
    gate.leave();
    ASSERT_EQ(next.wait_for(5s), std::future_status::ready);
    EXPECT_EQ(next.get(), GatePass::Through);
}

TEST_F(TwoSources, without_a_lead_both_come_to_the_same_sweep)
{
    gate.arrive(0, 3);
    gate.arrive(1, 2);
    auto first = wait(0, 0);
    EXPECT_EQ(first.wait_for(50ms), std::future_status::timeout);
    gate.arrive(1, 3);
    ASSERT_EQ(first.wait_for(5s), std::future_status::ready);
    EXPECT_EQ(first.get(), GatePass::Through);
}

TEST_F(TwoSources, nobody_gets_in_while_it_is_held)
{
    gate.arrive(0, 1);
    gate.arrive(1, 1);
    gate.hold();
    gate.hold();
    auto waiting = wait(0);
    gate.release();
    EXPECT_EQ(waiting.wait_for(50ms), std::future_status::timeout);
    gate.release();
    ASSERT_EQ(waiting.wait_for(5s), std::future_status::ready);
    EXPECT_EQ(waiting.get(), GatePass::Through);
}
