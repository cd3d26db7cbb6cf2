/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optotune_triangle.h"

#include "error_of.h"
#include "fake_optotune.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

using namespace std::chrono_literals;

namespace {

std::optional<dff::FocusPoints> points_of(const std::string &lines)
{
    const auto path =
        std::filesystem::temp_directory_path() / ("dff-triangle-" + std::to_string(getpid()) + ".yaml");
    std::ofstream(path) << "%YAML:1.0\n---\nlens: \"EL-16-40\"\n" << lines;
    auto points = dff::FocusPoints::load(path.string());
    std::filesystem::remove(path);
    return points;
}

/* 50 mA a dioptre. */
std::optional<dff::FocusPoints> straight()
{
    return points_of("vergence: [ 0, 5 ]\nposition: [ 0, 250 ]\nunit: \"mA\"\n");
}

dff::LensSweep sweep(double near, double far, std::chrono::microseconds period = 10ms)
{
    return {dff::SweepPlan::even(3, near, far), period};
}

void expect_triangle(FakeOptotune &driver)
{
    const auto triangle = driver.triangle();
    ASSERT_TRUE(triangle);
    EXPECT_NEAR(triangle->lower, -50, 0.1);
    EXPECT_NEAR(triangle->upper, 250, 0.1);
    EXPECT_NEAR(triangle->hertz, 1e3 / 60, 1e-3); /* six frames of 10 ms, to and fro */
}

} // namespace

/* What the maker's table of commands gives, byte for byte: the triangle, 100 mA above, 50 mA below, 100 Hz.
 */
TEST(OptotuneDriver, checksums_of_the_signal_are_those_of_the_table)
{
    const auto crc = [](const std::string &text) {
        const std::vector<std::uint8_t> bytes(text.begin(), text.end());
        return dff::crc16_ibm(bytes);
    };
    using namespace std::string_literals;
    EXPECT_EQ(crc("MwTA"), 0x8659);
    EXPECT_EQ(crc("PwUA\x05\x7a\x00\x00"s), 0x2413);
    EXPECT_EQ(crc("PwLA\x02\xbd\x00\x00"s), 0xa4a1);
    EXPECT_EQ(crc("PwFA\x00\x01\x86\xa0"s), 0x4a03);
}

TEST(OptotuneTriangle, turns_half_a_plane_beyond_near_and_far_and_ends_without_current)
{
    FakeOptotune driver;
    {
        dff::OptotuneTriangle lens(driver.device(), straight());
        lens.prepare(sweep(4, 0));
        EXPECT_FALSE(driver.triangle());
        lens.start();
        expect_triangle(driver);
        EXPECT_EQ(lens.code(0), 2797); /* 200 of 292.84 mA by 4095 */
        EXPECT_EQ(lens.code(2), 0);
        EXPECT_TRUE(lens.goes_to_and_fro());
        lens.check();
    }
    EXPECT_FALSE(driver.triangle());
    EXPECT_EQ(driver.moves().back(), "0 mA");
}

TEST(OptotuneTriangle, firmware_that_answers_with_three_letters_is_understood)
{
    FakeOptotune driver;
    driver.answer_with_three_letters();
    dff::OptotuneTriangle lens(driver.device(), straight());
    lens.prepare(sweep(4, 0));
    lens.start();
    expect_triangle(driver);
}

TEST(OptotuneTriangle, what_a_cable_loses_is_said_again)
{
    FakeOptotune driver;
    dff::OptotuneTriangle lens(driver.device(), straight());
    driver.lose_bytes(67);
    lens.prepare(sweep(4, 0));
    lens.start();
    expect_triangle(driver);
    driver.lose_bytes(0);
}

TEST(OptotuneTriangle, what_it_cannot_do_is_told)
{
    FakeOptotune driver;
    const auto without = error_of([&] { dff::OptotuneTriangle(driver.device(), {}); });
    EXPECT_NE(without.find("with unit \"mA\""), std::string::npos) << without;
    const auto dioptres = points_of("vergence: [ 0, 5 ]\nposition: [ -1, 4 ]\n");
    EXPECT_NE(error_of([&] { dff::OptotuneTriangle(driver.device(), dioptres); }), "");

    dff::OptotuneTriangle lens(driver.device(), straight());
    const auto range = error_of([&] { lens.prepare(sweep(5, 0)); });
    EXPECT_NE(range.find("-292.83 to 292.83 mA"), std::string::npos) << range;
    EXPECT_NE(range.find("-62.5 to 312.5"), std::string::npos) << range;
    const auto beyond = error_of([&] { lens.prepare(sweep(6, 0)); });
    EXPECT_NE(beyond.find("0 to 5"), std::string::npos) << beyond;
    const auto slow = error_of([&] { lens.prepare(sweep(4, 0, 1s)); });
    EXPECT_NE(slow.find("0.2 to 2000 times a second"), std::string::npos) << slow;
    const auto unknown = error_of([&] { lens.prepare(sweep(4, 0, 0s)); });
    EXPECT_NE(unknown.find("frame rate is not known"), std::string::npos) << unknown;

    const auto bent = points_of("vergence: [ 0, 1, 5 ]\nposition: [ 0, 100, 250 ]\nunit: \"mA\"\n");
    dff::OptotuneTriangle crooked(driver.device(), bent);
    const auto uneven = error_of([&] { crooked.prepare(sweep(4, 0)); });
    EXPECT_NE(uneven.find("even in its current"), std::string::npos) << uneven;
    const auto falling = points_of("vergence: [ 0, 5 ]\nposition: [ 250, 0 ]\nunit: \"mA\"\n");
    dff::OptotuneTriangle reversed(driver.device(), falling);
    const auto farthest = error_of([&] { reversed.prepare(sweep(4, 0)); });
    EXPECT_NE(farthest.find("that of the nearest plane"), std::string::npos) << farthest;
}

TEST(OptotuneTriangle, a_hot_lens_is_stopped)
{
    FakeOptotune driver;
    dff::OptotuneTriangle lens(driver.device(), straight());
    lens.prepare(sweep(4, 0));
    lens.start();
    driver.set_temperature(80);
    const auto error = error_of([&] { lens.check(); });
    EXPECT_NE(error.find("80 degrees Celsius"), std::string::npos) << error;
    EXPECT_FALSE(driver.triangle());
}
