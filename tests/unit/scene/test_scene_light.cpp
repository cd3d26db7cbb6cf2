/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/scene_light.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

using dff::SceneLight;

TEST(SceneLight, is_steady_unless_told_otherwise)
{
    EXPECT_TRUE(SceneLight().steady());
    EXPECT_DOUBLE_EQ(SceneLight().gain(17, 0.3, 0.006), 1.0);
}

TEST(SceneLight, an_exposure_of_whole_periods_sees_no_flicker)
{
    EXPECT_NEAR((SceneLight{0.8, 100.0, 0}).gain(0, 0.0123, 0.02), 1.0, 1e-12);
}

TEST(SceneLight, a_short_exposure_sees_the_light_of_its_instant)
{
    const SceneLight light{0.5, 100.0, 0};
    EXPECT_NEAR(light.gain(0, 0.0025, 1e-9), 1.5, 1e-6);
    EXPECT_NEAR(light.gain(0, 0.0075, 0.0), 0.5, 1e-6);
    double sum = 0.0;
    for (int i = 0; i < 1000; i++)
        sum += 1.0 + 0.5 * std::sin(2.0 * std::numbers::pi * 100.0 * (0.001 + 0.006 * (i + 0.5) / 1000.0));
    EXPECT_NEAR(light.gain(0, 0.001, 0.006), sum / 1000.0, 1e-6);
}

TEST(SceneLight, is_switched_by_the_frame)
{
    const SceneLight light{0.0, 100.0, 3};
    for (const auto &[frame, gain] : {std::pair(0, 1.0), {2, 1.0}, {3, 0.5}, {5, 0.5}, {6, 1.0}})
        EXPECT_DOUBLE_EQ(light.gain(static_cast<uint64_t>(frame), 0.0, 0.006), gain) << frame;
}
