/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "max14574_lens.h"

#include "fake_i2c_bus.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <thread>
#include <unistd.h>

using namespace std::chrono_literals;

namespace {

using Transfers = std::vector<std::string>;

/* A lens with the shipped profile: -5 to 15 dioptres over all codes, 20 ms to settle. */
class Max14574 : public testing::Test {
protected:
    std::unique_ptr<dff::Max14574Lens> open()
    {
        auto lens = std::make_unique<dff::Max14574Lens>(std::make_unique<FakeI2cBus>(bus_),
                                                        dff::LensProfile::load(SHIPPED_PROFILE));
        lens->prepare({dff::SweepPlan::even(3, 15.0, -5.0)});
        bus_.transfers.clear();
        return lens;
    }

    I2cRecord bus_;
};

} // namespace

TEST_F(Max14574, profile_of_another_driver_is_refused)
{
    const auto path =
        std::filesystem::temp_directory_path() / ("dff-codes-" + std::to_string(getpid()) + ".yaml");
    std::ofstream(path)
        << "%YAML:1.0\n---\nlens: test\nnominal: 1\npower_at_infinity: 0\nlens_power: [ 0, 10 ]\n"
           "driver: MAX14515\ncodes: [ 40, 200 ]\nsettle_us: 100\n";
    const auto profile = dff::LensProfile::load(path);
    std::filesystem::remove(path);
    EXPECT_THROW(dff::Max14574Lens(std::make_unique<FakeI2cBus>(bus_), profile), std::invalid_argument);
    EXPECT_TRUE(bus_.transfers.empty());
}

TEST_F(Max14574, a_code_is_staged_in_two_registers_and_committed)
{
    const auto lens = open();
    lens->start();
    lens->move_to(0);
    lens->move_to(1);
    lens->move_to(2);
    lens->stop();
    EXPECT_EQ(bus_.transfers, (Transfers{"b03=03", "b04=c0", "b08=ff", "b09=02", /* 1023 */
                                         "b04=00", "b08=80", "b09=02",           /* 512 */
                                         "b04=00", "b08=00", "b09=02",           /* 0 */
                                         "b03=00"}));
    EXPECT_EQ(lens->code(0), 1023);
    EXPECT_EQ(lens->code(1), 512);
    EXPECT_EQ(lens->code(2), 0);
}

TEST_F(Max14574, powers_out_of_reach_are_refused_and_nothing_is_written)
{
    const auto lens = open();
    EXPECT_THROW(lens->prepare({dff::SweepPlan::even(3, 16.0, 0.0)}), std::invalid_argument);
    EXPECT_TRUE(bus_.transfers.empty());
    EXPECT_EQ(lens->code(0), 1023);
}

TEST_F(Max14574, missing_driver_is_an_error_at_once)
{
    bus_.fails_after = 0;
    EXPECT_THROW(open(), dff::LensError);
    EXPECT_EQ(bus_.transfers.size(), 3U);
}

TEST_F(Max14574, each_write_is_tried_three_times)
{
    const auto lens = open();
    lens->start();
    bus_.transfers.clear();
    bus_.failures = 2;
    EXPECT_NO_THROW(lens->move_to(1));
    EXPECT_EQ(bus_.transfers, (Transfers{"failed", "failed", "b04=00", "b08=80", "b09=02"}));
}

TEST_F(Max14574, write_that_keeps_failing_puts_the_lens_to_sleep)
{
    const auto lens = open();
    lens->start();
    bus_.transfers.clear();
    bus_.failures = 3;
    EXPECT_THROW(lens->move_to(0), dff::LensError);
    EXPECT_EQ(bus_.transfers, (Transfers{"failed", "failed", "failed", "b03=00"}));
}

TEST_F(Max14574, dead_bus_ends_in_an_error_after_few_tries)
{
    auto lens = open();
    lens->start();
    for (const int good : {0, 1, 2}) {
        bus_.transfers.clear();
        bus_.fails_after = good;
        EXPECT_THROW(lens->move_to(0), dff::LensError);
        EXPECT_EQ(bus_.transfers.size(), 6U + static_cast<unsigned>(good));
    }
    EXPECT_NO_THROW(lens.reset());
}

TEST_F(Max14574, lens_is_put_to_sleep_when_it_is_let_go)
{
    auto lens = open();
    lens->start();
    bus_.transfers.clear();
    lens.reset();
    EXPECT_EQ(bus_.transfers, (Transfers{"b03=00"}));
}

TEST_F(Max14574, settling_takes_the_profiles_time_and_can_be_interrupted)
{
    const auto lens = open();
    lens->start();
    lens->move_to(0);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_TRUE(lens->wait_settled({}));
    EXPECT_GE(std::chrono::steady_clock::now() - begin, 20ms);

    lens->start();
    std::stop_source stop;
    std::jthread stopper([&stop] {
        std::this_thread::sleep_for(5ms);
        stop.request_stop();
    });
    for (int i = 0; i < 500; ++i)
        lens->move_to(0); /* 500 times 20 ms to settle */
    EXPECT_FALSE(lens->wait_settled(stop.get_token()));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s);
}

TEST_F(Max14574, driver_without_its_voltage_is_an_error)
{
    const auto lens = open();
    lens->start();
    lens->move_to(0);
    bus_.values[0] = 0x04;
    EXPECT_THROW(lens->wait_settled({}), dff::LensError);
    EXPECT_EQ(bus_.transfers.back(), "b03=00");
    bus_.values[0] = 0x10;
    EXPECT_THROW(lens->wait_settled({}), dff::LensError);
}
