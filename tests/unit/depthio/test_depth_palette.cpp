/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/depth_palette.h"
#include "depthio/depth_range.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>
#include <utility>

using namespace dff;

namespace {

constexpr double hue_step = 1.0 / 1275;

Colour with_noise(Colour colour, int channel, int noise)
{
    auto &value = colour[static_cast<size_t>(channel)];
    value = static_cast<uint8_t>(std::clamp(value + noise, 0, 255));
    return colour;
}

} // namespace

TEST(DepthPalette, hue_comes_back_within_a_step)
{
    const PaletteColours hue(DepthPalette::Hue);
    for (double position = 0.0; position <= 1.0; position += 1.0 / 5000)
        EXPECT_NEAR(hue_position(hue.at(position)).value(), position, 0.51 * hue_step);
}

TEST(DepthPalette, noise_never_turns_near_into_far)
{
    const PaletteColours hue(DepthPalette::Hue);
    for (double position = 0.0; position <= 1.0; position += 0.01)
        for (int channel = 0; channel < 3; channel++)
            for (int noise = -30; noise <= 30; noise++)
                EXPECT_NEAR(hue_position(with_noise(hue.at(position), channel, noise)).value(), position,
                            0.03);
}

TEST(DepthPalette, a_wrong_brightness_does_no_harm)
{
    for (const Colour colour : {Colour{200, 100, 0}, Colour{255, 155, 55}, Colour{180, 90, 0}})
        EXPECT_NEAR(hue_position(colour).value(), 0.1, hue_step);
}

TEST(DepthPalette, black_stays_no_value_with_a_margin)
{
    EXPECT_FALSE(hue_position(no_value_colour));
    for (int channel = 0; channel < 3; channel++)
        EXPECT_FALSE(hue_position(with_noise(no_value_colour, channel, 100)));
    EXPECT_FALSE(hue_position({255, 255, 255}));
}

TEST(DepthPalette, near_is_warm_and_nothing_known_is_black)
{
    for (const auto palette : {DepthPalette::Turbo, DepthPalette::Jet, DepthPalette::Hue}) {
        const PaletteColours colours(palette);
        EXPECT_GT(colours.at(0.1)[0], colours.at(0.1)[2]);
        EXPECT_LT(colours.at(0.9)[0], colours.at(0.9)[2]);
    }
    for (const auto palette : {DepthPalette::Turbo, DepthPalette::Jet, DepthPalette::Gray, DepthPalette::Hue})
        for (double position = 0.0; position <= 1.0; position += 0.001)
            EXPECT_GE(std::ranges::max(PaletteColours(palette).at(position)), 40);
}

TEST(DepthRange, dioptres_are_even)
{
    const DepthRange range(dioptre_scale(5, 1), std::nullopt, std::nullopt);
    EXPECT_NEAR(range.position(1).value(), 0.0, 1e-9);
    EXPECT_NEAR(range.position(65535).value(), 1.0, 1e-9);
    EXPECT_FALSE(range.position(0));
    for (unsigned pixel = 1; pixel <= 65535; pixel += 7)
        EXPECT_EQ(range.pixel(range.position(static_cast<uint16_t>(pixel)).value()), pixel);
}

TEST(DepthRange, a_narrow_range_clamps)
{
    const DepthRange range(dioptre_scale(5, 1), 4, 2);
    EXPECT_EQ(range.position(1), 0.0);
    EXPECT_EQ(range.position(65535), 1.0);
    EXPECT_NEAR(range.position(32768).value(), 0.5, 1e-4);
}

TEST(DepthRange, millimetres_are_even_in_dioptres)
{
    const DepthRange range({DepthUnit::Millimetre, 1, 0}, 4, 0);
    EXPECT_NEAR(range.position(250).value(), 0.0, 1e-9);
    EXPECT_NEAR(range.position(500).value(), 0.5, 1e-9);
    EXPECT_EQ(range.pixel(0.5), 500);
    EXPECT_EQ(range.pixel(1.0), 65535); /* infinity */
}

TEST(DepthRange, what_is_missing_is_told)
{
    EXPECT_THROW(DepthRange({DepthUnit::Millimetre, 1, 0}, std::nullopt, 1), std::invalid_argument);
    EXPECT_THROW(DepthRange({DepthUnit::Millimetre, 1, 0}, 1, 2), std::invalid_argument);
    EXPECT_NO_THROW(DepthRange({DepthUnit::Index, 1, 0}, std::nullopt, std::nullopt));
}

TEST(DepthRange, numbers_of_a_damaged_meta_are_told)
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double inf = std::numeric_limits<double>::infinity();
    for (const DepthUnit unit : {DepthUnit::Dioptre, DepthUnit::Millimetre})
        for (const DepthScale scale :
             {DepthScale{unit, nan, 0}, DepthScale{unit, 1, nan}, DepthScale{unit, inf, 0},
              DepthScale{unit, 1, -inf}, DepthScale{unit, 0, 1}})
            EXPECT_THROW(DepthRange(scale, 5, 1), std::invalid_argument)
                << scale.scale << " " << scale.offset;
    for (const auto &[near, far] :
         {std::pair{nan, 1.0}, {5.0, nan}, {inf, 1.0}, {5.0, -inf}, {1e308, -1e308}})
        EXPECT_THROW(DepthRange(dioptre_scale(5, 1), near, far), std::invalid_argument) << near << " " << far;
}
