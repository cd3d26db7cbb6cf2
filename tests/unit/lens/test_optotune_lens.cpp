/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optotune_lens.h"

#include "error_of.h"
#include "fake_optotune.h"

#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

using namespace std::chrono_literals;

namespace {

dff::LensSweep sweep(unsigned planes, double near, double far)
{
    return {dff::SweepPlan::even(planes, near, far)};
}

std::optional<dff::FocusPoints> points_of(const std::string &lines)
{
    const auto path =
        std::filesystem::temp_directory_path() / ("dff-optotune-" + std::to_string(getpid()) + ".yaml");
    std::ofstream(path) << "%YAML:1.0\n---\nlens: \"EL-16-40\"\n" << lines;
    auto points = dff::FocusPoints::load(path.string());
    std::filesystem::remove(path);
    return points;
}

void move_through(dff::OptotuneLens &lens, unsigned planes)
{
    for (unsigned plane = 0; plane < planes; ++plane) {
        lens.move_to(plane);
        EXPECT_TRUE(lens.wait_settled({}));
    }
}

using Moves = std::vector<std::string>;

} // namespace

/* Messages that programs of others send, byte for byte: "MwDA" with 54 46, "MwCA" with 56 76, "TA" with fe
 * f0, and the limits of temperature with 32 37 (luckygg/Optotune). */
TEST(OptotuneDriver, checksum_is_the_one_on_the_line)
{
    const auto crc = [](const std::string &text) {
        const std::vector<std::uint8_t> bytes(text.begin(), text.end());
        return dff::crc16_ibm(bytes);
    };
    EXPECT_EQ(crc("MwDA"), 0x4654);
    EXPECT_EQ(crc("MwCA"), 0x7656);
    EXPECT_EQ(crc("TA"), 0xf0fe);
    EXPECT_EQ(crc(std::string("PwTA\x02\x30\x01\x40", 8)), 0x3732);
}

TEST(OptotuneLens, planes_are_focal_powers_and_the_end_is_without_current)
{
    FakeOptotune driver;
    {
        dff::OptotuneLens lens(driver.device(), {});
        EXPECT_TRUE(lens.calibrated());
        lens.prepare(sweep(3, 3.0, 0.0));
        lens.start();
        move_through(lens, 3);
        EXPECT_EQ(lens.code(0), 600);
        EXPECT_EQ(lens.code(1), 300);
    }
    EXPECT_EQ(driver.moves(), (Moves{"3 D", "1.5 D", "0 D", "0 mA"}));
    EXPECT_EQ(driver.faults(), 0U);
}

TEST(OptotuneLens, older_drivers_count_from_5_dioptres)
{
    FakeOptotune driver('A');
    dff::OptotuneLens lens(driver.device(), {});
    lens.prepare(sweep(2, 3.5, -1.5));
    move_through(lens, 2);
    EXPECT_EQ(driver.moves(), (Moves{"3.5 D", "-1.5 D"}));
    EXPECT_EQ(lens.code(1), 700);
}

TEST(OptotuneLens, powers_out_of_range_are_named_with_the_range)
{
    FakeOptotune driver;
    dff::OptotuneLens lens(driver.device(), {});
    const std::string error = error_of([&] { lens.prepare(sweep(3, 5.0, 0.0)); });
    EXPECT_NE(error.find("reaches -1.5 to 3.5 dioptres"), std::string::npos) << error;
    EXPECT_NE(error.find("not 5"), std::string::npos) << error;
}

TEST(OptotuneLens, a_profile_moves_the_sweep_or_drives_by_current)
{
    FakeOptotune driver;
    {
        dff::OptotuneLens lens(driver.device(), points_of("vergence: [ 0, 5 ]\nposition: [ -1.5, 3.5 ]\n"));
        lens.prepare(sweep(2, 5.0, 0.0));
        move_through(lens, 2);
    }
    EXPECT_EQ(driver.moves(), (Moves{"3.5 D", "-1.5 D", "0 mA"}));
    dff::OptotuneLens lens(driver.device(),
                           points_of("vergence: [ 0, 5 ]\nposition: [ 0, 200 ]\nunit: \"mA\"\n"));
    lens.prepare(sweep(2, 5.0, 2.5));
    move_through(lens, 2);
    const Moves moves = driver.moves();
    ASSERT_EQ(moves.size(), 5U);
    EXPECT_NEAR(std::stod(moves[3]), 200, 0.04); /* half a step of the driver */
    EXPECT_NEAR(std::stod(moves[4]), 100, 0.04);
    EXPECT_EQ(lens.code(0), 2797);
    EXPECT_NE(error_of([&] {
                  dff::OptotuneLens(driver.device(),
                                    points_of("vergence: [ 0, 5 ]\nposition: [ 0, 1 ]\nunit: \"V\"\n"));
              }).find("\"mA\""),
              std::string::npos);
}

TEST(OptotuneLens, what_gets_lost_is_said_again)
{
    FakeOptotune driver;
    dff::OptotuneLens lens(driver.device(), {});
    lens.prepare(sweep(4, 3.0, 0.0));
    driver.lose_bytes(67);
    for (int i = 0; i < 5; i++)
        move_through(lens, 4);
    driver.lose_bytes(0);
    Moves seen; /* without what was said twice */
    for (const std::string &move : driver.moves())
        if (seen.empty() || seen.back() != move)
            seen.push_back(move);
    ASSERT_EQ(seen.size(), 20U);
    for (size_t k = 0; k < seen.size(); k++)
        EXPECT_EQ(seen[k], (Moves{"3 D", "2 D", "1 D", "0 D"})[k % 4]);
}

TEST(OptotuneLens, late_answers_are_waited_for_and_too_late_ones_do_not_confuse)
{
    FakeOptotune driver;
    dff::OptotuneLens lens(driver.device(), {});
    lens.prepare(sweep(2, 3.0, 0.0));
    driver.answer_late(60ms);
    move_through(lens, 2);
    EXPECT_EQ(driver.moves(), (Moves{"3 D", "0 D"}));
    driver.answer_late(400ms);
    const std::string error = error_of([&] { lens.move_to(0); });
    EXPECT_NE(error.find("gives no answer"), std::string::npos) << error;
    driver.answer_late(0ms);
    std::this_thread::sleep_for(1000ms); /* what was late is still on its way */
    lens.move_to(1);
    EXPECT_EQ(driver.moves().back(), "0 D");
}

TEST(OptotuneLens, a_hot_lens_is_left_without_current)
{
    FakeOptotune driver;
    dff::OptotuneLens lens(driver.device(), {});
    lens.prepare(sweep(2, 3.0, 0.0));
    move_through(lens, 2);
    driver.set_temperature(71.5);
    const std::string error = error_of([&] { move_through(lens, 2); });
    EXPECT_NE(error.find("has 71.5 degrees"), std::string::npos) << error;
    EXPECT_EQ(driver.moves().back(), "0 mA");
}

TEST(OptotuneLens, a_lens_that_cannot_hold_its_power_says_what_to_do)
{
    FakeOptotune driver;
    driver.refuse_focal_power();
    dff::OptotuneLens lens(driver.device(), {});
    const std::string error = error_of([&] { lens.prepare(sweep(2, 3.0, 0.0)); });
    EXPECT_NE(error.find("unit \"mA\""), std::string::npos) << error;
}

TEST(OptotuneLens, unplugged_in_mid_sweep_is_an_error_and_it_may_come_back)
{
    auto driver = std::make_unique<FakeOptotune>();
    {
        dff::OptotuneLens lens(driver->device(), {});
        lens.prepare(sweep(2, 3.0, 0.0));
        move_through(lens, 2);
        driver->unplug();
        const std::string error = error_of([&] { move_through(lens, 2); });
        EXPECT_NE(error.find("unplugged"), std::string::npos) << error;
    }
    driver = std::make_unique<FakeOptotune>();
    dff::OptotuneLens lens(driver->device(), {});
    lens.prepare(sweep(2, 3.0, 0.0));
    move_through(lens, 2);
    EXPECT_EQ(driver->moves(), (Moves{"3 D", "0 D"}));
}

TEST(OptotuneLens, who_is_not_an_optotune_driver_is_told_so)
{
    const int master = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    ASSERT_GE(master, 0);
    grantpt(master);
    unlockpt(master);
    const std::string device = ptsname(master);
    const std::string silent = error_of([&] { dff::OptotuneLens(device, {}); });
    EXPECT_NE(silent.find("no Optotune Lens Driver answers on " + device), std::string::npos) << silent;
    close(master);
    EXPECT_NE(error_of([] { dff::OptotuneLens("/dev/ttyACM-none", {}); }).find("dialout"), std::string::npos);
    EXPECT_NE(error_of([] { dff::OptotuneLens("/dev/null", {}); }).find("no serial port"), std::string::npos);
}

TEST(OptotuneLens, two_hundred_starts_leave_no_file_open)
{
    FakeOptotune driver;
    const auto open_files = [] {
        return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                             std::filesystem::directory_iterator());
    };
    const auto before = open_files();
    for (int cycle = 0; cycle < 200; cycle++) {
        dff::OptotuneLens lens(driver.device(), {});
        lens.prepare(sweep(2, 3.0, 0.0));
        lens.start();
        lens.move_to(0);
        lens.stop();
    }
    EXPECT_EQ(open_files(), before);
    EXPECT_EQ(driver.faults(), 0U);
}

TEST(OptotuneLens, a_driver_that_knows_no_temperature_limits_is_given_some)
{
    FakeOptotune driver;
    driver.forget_temperature_limits();
    dff::OptotuneLens lens(driver.device(), {});
    lens.prepare(sweep(3, 3.0, 0.0));
    move_through(lens, 3);
    EXPECT_EQ(driver.moves().back(), "0 D");
}
