/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lenssweep/frame_cycle.h"

#include <gtest/gtest.h>

namespace {

constexpr uint64_t period = 1000;

/* Sweep and plane as one number. */
class Cycle : public testing::Test {
protected:
    uint64_t numbered(uint64_t number) { return count({number, std::nullopt, false}); }
    uint64_t timed(uint64_t time, bool discontinuous) { return count({std::nullopt, time, discontinuous}); }

    uint64_t count(const FrameTrace &frame)
    {
        const PlaneLabel label = cycle_.label(frame);
        EXPECT_LT(label.plane, 4U);
        return label.sweep * 4 + label.plane;
    }

    FrameCycle cycle_{4, period};
};

} // namespace

TEST_F(Cycle, frames_are_counted)
{
    for (uint64_t i = 0; i < 10; i++)
        EXPECT_EQ(count({}), i);
}

TEST_F(Cycle, lost_frames_are_counted_by_their_numbers)
{
    EXPECT_EQ(numbered(70), 0U);
    EXPECT_EQ(numbered(71), 1U);
    EXPECT_EQ(numbered(77), 7U);
    EXPECT_EQ(numbered(77), 7U) << "a repeated frame is the same plane";
    EXPECT_FALSE(cycle_.lost_place());
}

TEST_F(Cycle, numbers_that_go_back_begin_a_new_sweep)
{
    numbered(70);
    EXPECT_EQ(numbered(72), 2U);
    EXPECT_EQ(numbered(3), 4U);
    EXPECT_TRUE(cycle_.lost_place());
    EXPECT_EQ(numbered(4), 5U);
    EXPECT_FALSE(cycle_.lost_place());
}

TEST_F(Cycle, lost_frames_are_counted_by_time_at_a_discontinuity)
{
    EXPECT_EQ(timed(500, true), 0U) << "every stream begins with one";
    EXPECT_EQ(timed(1500, false), 1U);
    EXPECT_EQ(timed(4400, true), 4U);
    EXPECT_FALSE(cycle_.lost_place());
}

TEST_F(Cycle, late_timestamps_alone_lose_nothing)
{
    timed(0, true);
    EXPECT_EQ(timed(1900, false), 1U);
    EXPECT_EQ(timed(2000, false), 2U);
}

TEST_F(Cycle, a_discontinuity_of_unknown_length_begins_a_new_sweep)
{
    count({});
    EXPECT_EQ(count({}), 1U);
    EXPECT_EQ(count({std::nullopt, std::nullopt, true}), 4U);
    EXPECT_TRUE(cycle_.lost_place());
    cycle_.set_period(std::nullopt);
    EXPECT_EQ(timed(9000, true), 8U);
    EXPECT_TRUE(cycle_.lost_place());
}

TEST_F(Cycle, a_restart_begins_a_new_sweep_and_is_no_loss)
{
    count({});
    EXPECT_EQ(count({}), 1U);
    cycle_.restart();
    EXPECT_EQ(count({}), 4U);
    EXPECT_FALSE(cycle_.lost_place());
}
