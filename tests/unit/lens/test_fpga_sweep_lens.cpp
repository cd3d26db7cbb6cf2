/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fpga_sweep_lens.h"

#include "fake_i2c_bus.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

using namespace dff::sweep_registers;
using namespace std::chrono_literals;

namespace {

I2cRecord answering_sequencer()
{
    I2cRecord bus;
    bus.values = {{static_cast<unsigned>(Word::identity), identity_default},
                  {static_cast<unsigned>(Word::version), version_default},
                  {static_cast<unsigned>(Word::lens_gap_us), 291U},
                  {static_cast<unsigned>(Word::lens_stage_us), 146U}};
    return bus;
}

dff::LensProfile shipped()
{
    return dff::LensProfile::load(SHIPPED_PROFILE);
}

bool has(const I2cRecord &bus, const std::string &transfer)
{
    return std::find(bus.transfers.begin(), bus.transfers.end(), transfer) != bus.transfers.end();
}

/* A profile from 0 to 10 dioptres, with an overdrive. */
dff::LensProfile with_overdrive(const std::string &drives = "volts: [ 30, 60 ]")
{
    const auto path =
        std::filesystem::temp_directory_path() / ("dff-overdrive-" + std::to_string(getpid()) + ".yaml");
    std::ofstream(path)
        << "%YAML:1.0\n---\nlens: \"test\"\nnominal: 1\npower_at_infinity: 0\nlens_power: [ 0, 10 ]\n"
        << drives << "\nsettle_us: 100\noverdrive: 0.5\noverdrive_delay_us: 9\n";
    const auto profile = dff::LensProfile::load(path);
    std::filesystem::remove(path);
    return profile;
}

} // namespace

TEST(FpgaSweepLens, plan_becomes_the_table_of_the_sequencer)
{
    I2cRecord bus = answering_sequencer();
    dff::FpgaSweepLens lens(std::make_unique<FakeI2cBus>(bus), shipped());
    lens.prepare({dff::SweepPlan::even(3, 15.0, -5.0), 6400us, 6000us, true});
    /* planes, shape, period, exposure, flyback, width, opto on and off, the words of the MAX14574: from 0x0d
     * on, low byte first */
    EXPECT_TRUE(has(bus, "block8d=030000000019701700006400000000007700030304080902"));
    /* plane, code A, delay, code B, settle: the shipped profile has no overdrive, and settles longer than 109
     * us */
    EXPECT_TRUE(has(bus, "block99=0000ff030000ff036d00"));
    EXPECT_TRUE(has(bus, "block99=010000020000"
                         "00026d00"));
    EXPECT_TRUE(has(bus, "w0c=0001"));
    EXPECT_EQ(lens.code(1), 512);
    lens.start();
    EXPECT_EQ(bus.transfers.back(), "w02=0003");
    lens.stop();
    EXPECT_EQ(bus.transfers.back(), "w02=0000");
}

TEST(FpgaSweepLens, first_code_of_a_plane_goes_beyond_the_second)
{
    const auto steps = dff::plane_steps(dff::SweepPlan::even(3, 10.0, 0.0), with_overdrive());
    ASSERT_EQ(steps.size(), 3U);
    EXPECT_DOUBLE_EQ(steps[0].overdrive, 69.9); /* 60 + 15, as far as the driver can */
    EXPECT_DOUBLE_EQ(steps[0].hold, 60.0);
    EXPECT_DOUBLE_EQ(steps[1].overdrive, 37.5);
    EXPECT_DOUBLE_EQ(steps[1].hold, 45.0);
    EXPECT_DOUBLE_EQ(steps[2].overdrive, 24.4);
    EXPECT_DOUBLE_EQ(steps[2].hold, 30.0);
    EXPECT_EQ(steps[1].delay, 9us);
    EXPECT_EQ(steps[1].settle, 100us);
}

TEST(FpgaSweepLens, profile_for_a_max14515_goes_to_the_sequencer_in_its_codes)
{
    const auto profile = with_overdrive("driver: MAX14515\ncodes: [ 40, 200 ]");
    I2cRecord bus = answering_sequencer();
    dff::FpgaSweepLens lens(std::make_unique<FakeI2cBus>(bus), profile);
    lens.prepare({dff::SweepPlan::even(3, 10.0, 0.0), 6400us, 6000us});
    /* ... and the words of the driver: 0x76, direct; 0x00 = 0x01 wakes it; 0x01 takes the code */
    EXPECT_TRUE(has(bus, "block8d=03000000001970170000640000000000f600000100010000"));
    EXPECT_TRUE(
        has(bus, "block99=0000fc03090020036400")); /* 255 x 4 (beyond 200 as far as it can), 200 x 4 */
    EXPECT_TRUE(has(bus, "block99=010040010900e0016400")); /* 80 x 4, 120 x 4 */
    EXPECT_TRUE(has(bus, "block99=020000000900a0006400"));
    EXPECT_EQ(lens.code(0), 200);
    EXPECT_EQ(lens.code(1), 120);

    bus.values[static_cast<unsigned>(Word::version)] = 0x0100;
    dff::FpgaSweepLens older(std::make_unique<FakeI2cBus>(bus), profile);
    bus.transfers.clear();
    try {
        older.prepare({dff::SweepPlan::even(3, 10.0, 0.0), 6400us, 6000us});
        FAIL() << "register map 1.0 has no bit for it";
    } catch (const dff::LensError &error) {
        EXPECT_NE(std::string(error.what()).find("newer bitstream"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(bus.transfers.empty());
}

TEST(FpgaSweepLens, exposure_left_open_is_what_the_lens_leaves)
{
    I2cRecord bus = answering_sequencer();
    dff::FpgaSweepLens lens(std::make_unique<FakeI2cBus>(bus), with_overdrive());
    lens.prepare({dff::SweepPlan::even(2, 10.0, 0.0), 6400us, 0us, false}); /* 6400 - 291 - 9 - 100 = 6000 */
    EXPECT_TRUE(has(bus, "block8d=020000000019701700006400000000007700030304080902"));
}

TEST(FpgaSweepLens, exposure_left_open_is_half_a_period_for_a_slow_lens)
{
    I2cRecord bus = answering_sequencer();
    dff::FpgaSweepLens lens(std::make_unique<FakeI2cBus>(bus), shipped()); /* 20 ms to settle */
    lens.prepare({dff::SweepPlan::even(2, 10.0, 0.0), 6400us, 0us, false});
    EXPECT_TRUE(has(bus, "block8d=020000000019800c00006400000000007700030304080902"));
}

TEST(FpgaSweepLens, times_and_powers_that_cannot_be_met_are_refused_with_the_rule)
{
    I2cRecord bus = answering_sequencer();
    dff::FpgaSweepLens lens(std::make_unique<FakeI2cBus>(bus), shipped());
    EXPECT_THROW(lens.prepare({dff::SweepPlan::even(3, 5.0, 0.0), 6400us, 6200us}), std::invalid_argument);
    EXPECT_THROW(lens.prepare({dff::SweepPlan::even(3, 20.0, 0.0), 6400us, 6000us}), std::invalid_argument);
}

TEST(FpgaSweepLens, sequencer_that_stopped_by_itself_is_an_error_that_says_why)
{
    I2cRecord bus = answering_sequencer();
    dff::FpgaSweepLens lens(std::make_unique<FakeI2cBus>(bus), shipped());
    EXPECT_NO_THROW(lens.check());
    bus.values[static_cast<unsigned>(Word::status)] = status_failed.mask();
    bus.values[static_cast<unsigned>(Word::error)] = error_lens_nack.mask();
    try {
        lens.check();
        FAIL() << "no error";
    } catch (const dff::LensError &error) {
        EXPECT_NE(std::string(error.what()).find("does not answer"), std::string::npos);
    }
}

TEST(FpgaSweepLens, sweep_is_stopped_when_the_lens_is_let_go)
{
    I2cRecord bus = answering_sequencer();
    {
        dff::FpgaSweepLens lens(std::make_unique<FakeI2cBus>(bus), shipped());
        lens.start();
    }
    EXPECT_EQ(bus.transfers.back(), "w02=0000");
}
