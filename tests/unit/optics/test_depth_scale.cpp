/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/depth_scale.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <stdexcept>

using dff::DepthEncoder;
using dff::DepthScale;
using dff::SweepPlan;

namespace {

const SweepPlan &uneven_plan()
{
    static const std::array powers{5.0, 4.5, 3.0, 1.0};
    static const SweepPlan plan = SweepPlan::at(powers);
    return plan;
}

} // namespace

class EveryUnit : public testing::TestWithParam<DepthEncoder> {};

TEST_P(EveryUnit, decode_undoes_encode)
{
    for (double z = 0.0; z <= 3.0; z += 0.0625)
        EXPECT_NEAR(GetParam().decode(GetParam().encode(z)).value(), z, 0.03) << "z = " << z;
}

TEST_P(EveryUnit, smaller_is_nearer)
{
    for (double z = 0.0; z < 3.0; z += 0.0625)
        EXPECT_LT(GetParam().encode(z), GetParam().encode(z + 0.0625));
}

TEST_P(EveryUnit, zero_is_no_value)
{
    EXPECT_EQ(GetParam().encode(NAN), DepthScale::no_value);
    EXPECT_FALSE(GetParam().decode(DepthScale::no_value).has_value());
    EXPECT_GE(GetParam().encode(-1.0), 1);
}

INSTANTIATE_TEST_SUITE_P(DepthEncoder, EveryUnit,
                         testing::Values(DepthEncoder::index(4), DepthEncoder::dioptre(uneven_plan()),
                                         DepthEncoder::millimetre(uneven_plan()),
                                         DepthEncoder::micrometre({0.0, 3.0, 4.0, 9.5})));

TEST_P(EveryUnit, slope_is_what_a_plane_makes)
{
    const DepthEncoder &encoder = GetParam();
    for (double z = 0.3; z < encoder.planes() - 1.5; z += 0.4) {
        const double pixels = (encoder.encode(z + 0.25) - encoder.encode(z - 0.25)) / 0.5;
        EXPECT_NEAR(encoder.slope(z), pixels, 0.05 * pixels + 3.0) << z;
    }
}

TEST(DepthEncoder, ends_of_the_scale)
{
    const DepthEncoder index = DepthEncoder::index(10);
    EXPECT_EQ(index.encode(0.0), 1);
    EXPECT_EQ(index.encode(9.0), 65535);
    EXPECT_EQ(index.encode(4.5), 32768);
    EXPECT_NEAR(index.scale().value(1), 0.0, 1e-12);
    EXPECT_NEAR(index.scale().value(65535), 9.0, 1e-12);

    const DepthEncoder dioptre = DepthEncoder::dioptre(SweepPlan::even(6, 5.0, 0.0));
    EXPECT_NEAR(dioptre.scale().value(1), 5.0, 1e-12);
    EXPECT_NEAR(dioptre.scale().value(65535), 0.0, 1e-12);
}

TEST(DepthEncoder, millimetres_are_millimetres_and_saturate)
{
    const DepthEncoder encoder = DepthEncoder::millimetre(SweepPlan::even(6, 5.0, 0.0));
    EXPECT_EQ(encoder.encode(0.0), 200);
    EXPECT_EQ(encoder.encode(4.0), 1000);
    EXPECT_EQ(encoder.encode(5.0), 65535);
}

TEST(DepthEncoder, micrometres_need_a_monotone_stage)
{
    EXPECT_THROW(DepthEncoder::micrometre({0.0, 2.0, 1.0}), std::invalid_argument);
    EXPECT_THROW(DepthEncoder::micrometre({0.0}), std::invalid_argument);
    EXPECT_EQ(DepthEncoder::micrometre({9.0, 4.0, 0.0}).encode(2.0), 65535);
}
