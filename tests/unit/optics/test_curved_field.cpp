/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/curved_field.h"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

using namespace dff;

namespace {

constexpr unsigned width = 41, height = 31;
const FocusCalibration focus{{4.0, 3.0, 1.5}, {0.1, -0.05, -0.3}};

double field(unsigned x, unsigned y)
{
    const double half = std::hypot(20.0, 15.0), right = (x - 20.0) / half, down = (y - 15.0) / half;
    return 0.1 * right - 0.05 * down - 0.3 * (right * right + down * down);
}

/* A map of the same vergence everywhere, but for one pixel without a value. */
std::vector<uint16_t> map_of(double vergence)
{
    std::vector<uint16_t> map(size_t{width} * height,
                              static_cast<uint16_t>(1 + std::lround(65534 * (4.0 - vergence) / 2.5)));
    map[7] = 0;
    return map;
}

std::vector<uint16_t> bent(const CurvedField &curve, double vergence)
{
    std::vector<uint16_t> map = map_of(vergence);
    curve.apply(reinterpret_cast<std::byte *>(map.data()), 2 * size_t{width});
    return map;
}

} // namespace

TEST(CurvedField, dioptres_get_what_the_field_adds)
{
    const CurvedField curve(focus, width, height, DepthUnit::Dioptre);
    for (const double vergence : {4.0, 2.7, 1.5}) {
        const std::vector<uint16_t> map = bent(curve, vergence);
        EXPECT_EQ(map[7], 0);
        for (unsigned y = 0; y < height; y++)
            for (unsigned x = 0; x < width; x++)
                if (y * width + x != 7) {
                    EXPECT_NEAR(curve.scale().value(map[y * width + x]), vergence + field(x, y), 1e-4);
                }
    }
    EXPECT_NEAR(curve.scale().value(1), curve.near(), 1e-9);
    EXPECT_NEAR(curve.scale().value(65535), curve.far(), 1e-9);
}

TEST(CurvedField, millimetres_are_those_of_the_bent_vergence)
{
    const CurvedField curve(focus, width, height, DepthUnit::Millimetre);
    const std::vector<uint16_t> map = bent(curve, 2.0);
    EXPECT_EQ(map[7], 0);
    for (unsigned y = 0; y < height; y++)
        for (unsigned x = 0; x < width; x++)
            if (y * width + x != 7) {
                EXPECT_NEAR(map[y * width + x], 1000.0 / (2.0 + field(x, y)), 0.6);
            }
}

/* A deviation is the difference that so much of depth makes. */
TEST(CurvedField, deviations_are_bent_as_depth_is)
{
    for (const DepthUnit unit : {DepthUnit::Dioptre, DepthUnit::Millimetre}) {
        const CurvedField curve(focus, width, height, unit);
        const std::vector<uint16_t> depth = bent(curve, 2.0), farther = bent(curve, 2.0 - 0.005 * 2.5);
        std::vector<uint16_t> deviations(depth.size(), static_cast<uint16_t>(std::lround(0.005 * 65534)));
        deviations[7] = 0;
        curve.apply_to_deviations(reinterpret_cast<std::byte *>(deviations.data()), 2 * size_t{width},
                                  reinterpret_cast<const std::byte *>(depth.data()), 2 * size_t{width});
        for (size_t i = 0; i < depth.size(); i++)
            EXPECT_NEAR(deviations[i], farther[i] - depth[i], unit == DepthUnit::Dioptre ? 2 : 1.2) << i;
    }
}

TEST(CurvedField, what_lies_beyond_infinity_is_as_far_as_millimetres_go)
{
    const FocusCalibration to_infinity{{2.0, 0.1}, {0.0, 0.0, -0.5}};
    const CurvedField curve(to_infinity, width, height, DepthUnit::Millimetre);
    std::vector<uint16_t> map(size_t{width} * height, 65535);
    curve.apply(reinterpret_cast<std::byte *>(map.data()), 2 * size_t{width});
    EXPECT_EQ(map[0], 65535);
    EXPECT_EQ(map[15 * width + 20], 10000);
    EXPECT_THROW(CurvedField(focus, width, height, DepthUnit::Index), std::invalid_argument);
}
