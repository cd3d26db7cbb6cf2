/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/sweep_plan.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <stdexcept>

using dff::SweepPlan;

TEST(SweepPlan, planes_are_even_in_dioptres)
{
    const SweepPlan plan = SweepPlan::even(6, 5.0, 0.0);
    for (unsigned z = 0; z < 6; z++)
        EXPECT_DOUBLE_EQ(plan.power(z), 5.0 - z);
}

TEST(SweepPlan, position_undoes_power)
{
    const std::array powers{4.0, 3.5, 1.0, 0.25, 0.0};
    const SweepPlan plan = SweepPlan::at(powers);
    for (double z = 0.0; z <= 4.0; z += 0.125)
        EXPECT_NEAR(plan.position_of(plan.power_at(z)), z, 1e-12);
}

TEST(SweepPlan, positions_outside_are_clamped)
{
    const SweepPlan plan = SweepPlan::even(3, 4.0, 2.0);
    EXPECT_DOUBLE_EQ(plan.power_at(-1.0), 4.0);
    EXPECT_DOUBLE_EQ(plan.power_at(9.0), 2.0);
    EXPECT_DOUBLE_EQ(plan.position_of(9.0), 0.0);
    EXPECT_DOUBLE_EQ(plan.position_of(0.0), 2.0);
}

TEST(SweepPlan, impossible_sweeps_are_refused)
{
    const std::array rising{1.0, 2.0};
    const std::array endless{1.0, static_cast<double>(-INFINITY)};
    EXPECT_THROW(SweepPlan::even(1, 1.0, 0.0), std::invalid_argument);
    EXPECT_THROW(SweepPlan::even(65, 1.0, 0.0), std::invalid_argument);
    EXPECT_THROW(SweepPlan::even(6, 0.0, 1.0), std::invalid_argument);
    EXPECT_THROW(SweepPlan::even(6, 1.0, 1.0), std::invalid_argument);
    EXPECT_THROW(SweepPlan::even(6, NAN, 0.0), std::invalid_argument);
    EXPECT_THROW(SweepPlan::at(rising), std::invalid_argument);
    EXPECT_THROW(SweepPlan::at(endless), std::invalid_argument);
}
