/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/rolling_window.h"

#include <gtest/gtest.h>
#include <random>
#include <stdexcept>
#include <vector>

using dff::FrameVerdict;
using dff::RollingWindow;

TEST(RollingWindow, is_full_once_every_plane_was_there)
{
    RollingWindow window(3);
    window.add(0, 1);
    window.add(0, 2);
    EXPECT_FALSE(window.full());
    window.add(1, 0);
    EXPECT_TRUE(window.full());
    EXPECT_EQ(window.stale(), 0u);
}

TEST(RollingWindow, a_lost_frame_leaves_its_plane_stale_until_the_next_one)
{
    RollingWindow window(3);
    for (unsigned z = 0; z < 3; z++)
        window.add(0, z);
    window.add(1, 0);
    window.add(1, 2);
    EXPECT_EQ(window.stale(), 0b010u);
    window.add(2, 0);
    EXPECT_EQ(window.stale(), 0b010u);
    window.add(2, 1);
    EXPECT_EQ(window.stale(), 0u);
    EXPECT_EQ(window.lost(), 1u);
}

TEST(RollingWindow, a_triangle_sweep_loses_nothing)
{
    RollingWindow window(4);
    for (uint64_t sweep = 0; sweep < 6; sweep++)
        for (unsigned i = 0; i < 4; i++) {
            EXPECT_EQ(window.add(sweep, sweep % 2 ? 3 - i : i), FrameVerdict::Taken);
            EXPECT_EQ(window.stale(), 0u) << "sweep " << sweep << " frame " << i;
        }
    EXPECT_EQ(window.lost(), 0u);
    EXPECT_EQ(window.reordered(), 0u);
}

TEST(RollingWindow, an_overtaken_frame_still_fits_a_late_one_does_not)
{
    RollingWindow window(3);
    for (unsigned z = 0; z < 3; z++)
        window.add(0, z);
    window.add(1, 1);
    EXPECT_EQ(window.add(1, 0), FrameVerdict::Taken);
    EXPECT_EQ(window.reordered(), 1u);
    EXPECT_EQ(window.add(0, 0), FrameVerdict::Late);
    EXPECT_EQ(window.add(1, 1), FrameVerdict::Repeated);
}

TEST(RollingWindow, a_source_that_numbers_anew_is_followed)
{
    RollingWindow window(3);
    for (unsigned z = 0; z < 3; z++)
        window.add(50, z);
    unsigned late = 0;
    for (uint64_t sweep = 0; sweep < 8; sweep++)
        for (unsigned z = 0; z < 3; z++)
            late += window.add(sweep, z) == FrameVerdict::Late;
    EXPECT_EQ(late, 15u);
    EXPECT_TRUE(window.full());
    EXPECT_EQ(window.stale(), 0u);
}

TEST(RollingWindow, no_disorder_brings_an_older_frame_back)
{
    for (unsigned seed = 0; seed < 200; seed++) {
        std::mt19937 random(seed);
        const unsigned planes = 2 + random() % 63;
        std::vector<std::pair<uint64_t, unsigned>> frames;
        for (uint64_t sweep = 0; sweep < 20; sweep++)
            for (unsigned z = 0; z < planes; z++)
                if (random() % 16 != 0)
                    frames.emplace_back(sweep, z);
        for (size_t i = 0; i + 8 < frames.size(); i++)
            if (random() % 8 == 0)
                std::swap(frames[i], frames[i + random() % 8]);

        RollingWindow window(planes);
        std::vector<int64_t> newest(planes, -1);
        for (const auto &[sweep, plane] : frames)
            if (window.add(sweep, plane) == FrameVerdict::Taken) {
                EXPECT_GT(static_cast<int64_t>(sweep), newest[plane]) << "seed " << seed;
                newest[plane] = static_cast<int64_t>(sweep);
            }
        EXPECT_LT(window.lost(), 20u * planes);
    }
}

TEST(RollingWindow, impossible_stacks_are_refused)
{
    EXPECT_THROW(RollingWindow(1), std::invalid_argument);
    EXPECT_THROW(RollingWindow(65), std::invalid_argument);
}
