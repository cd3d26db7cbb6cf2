/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sweep_table.h"

#include <gtest/gtest.h>

using namespace std::chrono_literals;

namespace {

const dff::LensTiming timing{291us, 146us};

dff::SweepTable paper_table() // 6 planes, 156.25 frames/s, 6 ms of exposure
{
    dff::SweepTable table;
    table.planes.assign(6, {40.0, 9us, 45.0, 100us});
    return table;
}

} // namespace

TEST(SweepTable, paper_sweep_fits_to_the_microsecond)
{
    auto table = paper_table();
    EXPECT_NO_THROW(dff::check(table, timing));
    table.planes[3].settle = 101us;
    EXPECT_THROW(dff::check(table, timing), std::invalid_argument);
}

TEST(SweepTable, volts_become_codes_over_the_whole_range)
{
    EXPECT_EQ(dff::max14574_driver.code(24.4), 0);
    EXPECT_EQ(dff::max14574_driver.code(69.9), 1023);
    EXPECT_EQ(dff::max14574_driver.code(47.2), 513);
    EXPECT_THROW(dff::max14574_driver.code(24.3), std::invalid_argument);
    EXPECT_THROW(dff::max14574_driver.code(70.0), std::invalid_argument);
}

TEST(SweepTable, codes_of_a_max14515_are_the_high_bits_of_the_sequencers)
{
    EXPECT_EQ(dff::max14515_driver.code(0), 0);
    EXPECT_EQ(dff::max14515_driver.code(127.6), 128);
    EXPECT_EQ(dff::max14515_driver.code(255), 255);
    EXPECT_EQ(dff::max14515_driver.table_code(255), 1020);
    EXPECT_THROW(dff::max14515_driver.code(-0.1), std::invalid_argument);
    EXPECT_THROW(dff::max14515_driver.code(255.1), std::invalid_argument);
}

TEST(SweepTable, what_the_sequencer_would_refuse_is_refused_here)
{
    const auto refused = [](auto change) {
        auto table = paper_table();
        change(table);
        EXPECT_THROW(dff::check(table, timing), std::invalid_argument);
    };
    refused([](auto &table) { table.planes.resize(1); });
    refused([](auto &table) { table.planes.resize(65, table.planes[0]); });
    refused([](auto &table) { table.exposure = 145us; });
    refused([](auto &table) { table.period = 70ms; });
    refused([](auto &table) { table.period = 5ms; });
    refused([](auto &table) { table.trigger_width = 0us; });
    refused([](auto &table) { table.trigger_width = 6001us; });
    refused([](auto &table) { table.opto_off = 100us; });
    refused([](auto &table) { table.opto_on = 101us; });
    refused([](auto &table) { table.planes[5].delay = 10us; });
    refused([](auto &table) { table.planes[0].hold = 0; });
    refused([](auto &table) { table.planes[0].overdrive = 256, table.driver = &dff::max14515_driver; });
    refused([](auto &table) { table.planes[0].settle = -1us; });
    refused([](auto &table) { table.flyback = -1us; });
}

TEST(SweepTable, active_low_trigger_leads_by_the_other_edge)
{
    auto table = paper_table();
    table.opto_on = 5us;
    table.opto_off = 101us;
    table.trigger_width = 200us;
    EXPECT_NO_THROW(dff::check(table, timing));
    table.trigger_active_low = true;
    EXPECT_THROW(dff::check(table, timing), std::invalid_argument);
}

TEST(SweepTable, settings_stand_in_one_block_and_each_plane_in_another)
{
    auto table = paper_table();
    table.triangle = true;
    const auto writes = dff::register_writes(table);
    ASSERT_EQ(writes.size(), 7u);
    EXPECT_EQ(writes[0].word, dff::sweep_registers::Word::planes);
    EXPECT_EQ(writes[0].values,
              (std::vector<std::uint16_t>{6, 1, 6400, 6000, 0, 100, 0, 0, 0x0077, 0x0303, 0x0804, 0x0209}));
    EXPECT_EQ(writes[2].word, dff::sweep_registers::Word::plane_select);
    EXPECT_EQ(writes[2].values, (std::vector<std::uint16_t>{1, 351, 9, 463, 100}));
}

TEST(SweepTable, words_of_the_driver_go_with_its_codes)
{
    auto table = paper_table();
    table.driver = &dff::max14515_driver;
    const auto writes = dff::register_writes(table);
    /* direct, 0x76; register 0 = 1 wakes it; register 1 takes the code; nothing commits it */
    EXPECT_EQ(writes[0].values,
              (std::vector<std::uint16_t>{6, 0, 6400, 6000, 0, 100, 0, 0, 0x00f6, 0x0100, 0x0100, 0x0000}));
    EXPECT_EQ(writes[2].values, (std::vector<std::uint16_t>{1, 160, 9, 180, 100}));
}
