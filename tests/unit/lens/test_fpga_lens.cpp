/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fpga_lens.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <sstream>

using namespace dff::sweep_registers;
using namespace std::chrono_literals;

namespace {

/* The registers as the sequencer would answer, and a record of every transfer in bytes on the bus after the
 * address. */
class RecordingBus : public dff::I2cBus {
public:
    std::map<std::uint8_t, std::uint16_t> words{{number(Word::identity), identity_default},
                                                {number(Word::version), version_default},
                                                {number(Word::lens_gap_us), std::uint16_t{291}},
                                                {number(Word::lens_stage_us), std::uint16_t{146}}};
    std::vector<std::string> transfers;
    int failures = 0; // of the next transfers

    static constexpr std::uint8_t number(Word word) { return static_cast<std::uint8_t>(word); }

    std::uint8_t read_byte(std::uint8_t) override { throw dff::I2cError("the sequencer has words only"); }
    void write_byte(std::uint8_t, std::uint8_t) override
    {
        throw dff::I2cError("the sequencer has words only");
    }

    std::uint16_t read_word(std::uint8_t command) override
    {
        fail_if_asked();
        transfers.push_back("read " + hex(command));
        return words[command];
    }

    void write_word(std::uint8_t command, std::uint16_t value) override
    {
        fail_if_asked();
        transfers.push_back("write " + hex(command) + hex(value & 0xff) + hex(value >> 8));
    }

    void write_block(std::uint8_t command, std::span<const std::uint8_t> bytes) override
    {
        fail_if_asked();
        std::string line = "write " + hex(command) + hex(static_cast<unsigned>(bytes.size()));
        for (const auto byte : bytes) {
            line += hex(byte);
        }
        transfers.push_back(line);
    }

private:
    static std::string hex(unsigned value)
    {
        char text[3];
        std::snprintf(text, sizeof text, "%02x", value & 0xff);
        return text;
    }

    void fail_if_asked()
    {
        if (failures > 0) {
            --failures;
            transfers.push_back("failed");
            throw dff::I2cError("no acknowledge");
        }
    }
};

/* A short sweep with another voltage and time in every place. */
dff::SweepTable contract_table()
{
    dff::SweepTable table;
    table.planes = {
        {30.0, 11us, 33.3, 21us}, {45.5, 0us, 41.2, 33us}, {69.9, 7us, 24.4, 0us}, {50.1, 3us, 52.7, 40us}};
    table.period = 600us;
    table.exposure = 240us;
    table.flyback = 55us;
    table.trigger_width = 80us;
    table.opto_on = 4us;
    table.opto_off = 9us;
    return table;
}

/* The same in the codes of a MAX14515. */
dff::SweepTable contract_table_in_codes()
{
    auto table = contract_table();
    table.driver = &dff::max14515_driver;
    for (auto &plane : table.planes) {
        plane.overdrive = std::round(plane.overdrive) * 3;
        plane.hold = std::round(plane.hold) * 3 + 1;
    }
    return table;
}

std::string describe(const dff::SweepTable &table)
{
    std::ostringstream text;
    text << "table driver=" << table.driver->name << " period=" << table.period.count()
         << " exposure=" << table.exposure.count() << " flyback=" << table.flyback.count()
         << " width=" << table.trigger_width.count() << " opto_on=" << table.opto_on.count()
         << " opto_off=" << table.opto_off.count() << "\n";
    for (const auto &plane : table.planes) {
        text << "plane a=" << plane.overdrive << " delay=" << plane.delay.count() << " b=" << plane.hold
             << " settle=" << plane.settle.count() << "\n";
    }
    return text.str();
}

/* All that a driver may send for a table, and what the sequencer is to do of it. */
std::string recorded(const dff::SweepTable &table)
{
    RecordingBus bus;
    std::string recording = describe(table);
    const auto flush = [&](const std::string &expectation) {
        for (const auto &transfer : bus.transfers) {
            recording += transfer + "\n";
        }
        bus.transfers.clear();
        recording += "expect " + expectation + "\n";
    };
    {
        dff::FpgaLens lens(bus);
        lens.load(table);
        flush("rest");
        lens.start(false);
        flush("sweeps");
        lens.status();
        lens.sweep_count();
        lens.frame_count();
        lens.stop();
        flush("rest");
        lens.start(true);
        flush("sweeps with run");
    }
    flush("rest");
    return recording;
}

bool has(const RecordingBus &bus, const std::string &transfer)
{
    return std::find(bus.transfers.begin(), bus.transfers.end(), transfer) != bus.transfers.end();
}

} // namespace

TEST(FpgaLens, bytes_on_the_bus_are_those_the_simulated_sequencer_is_tried_with)
{
    const std::string recording =
        "# Recorded by tests/unit/lens/test_fpga_lens.cpp: set UPDATE_CONTRACT=1 to write it anew.\n"
        "# fpga/test/test_contract.py plays it to the simulated sequencer.\n" +
        recorded(contract_table()) + recorded(contract_table_in_codes());
    if (std::getenv("UPDATE_CONTRACT")) {
        std::ofstream(CONTRACT) << recording;
    }
    std::stringstream committed;
    committed << std::ifstream(CONTRACT).rdbuf();
    EXPECT_EQ(recording, committed.str());
}

TEST(FpgaLens, another_device_at_the_address_is_refused)
{
    RecordingBus bus;
    bus.words[RecordingBus::number(Word::identity)] = 0xffff;
    EXPECT_THROW(dff::FpgaLens lens(bus), dff::I2cError);
    bus.words[RecordingBus::number(Word::identity)] = identity_default;
    bus.words[RecordingBus::number(Word::version)] = 0x0200;
    EXPECT_THROW(dff::FpgaLens lens(bus), dff::I2cError);
    bus.words[RecordingBus::number(Word::version)] = 0x0107;
    EXPECT_NO_THROW(dff::FpgaLens lens(bus));
}

TEST(FpgaLens, table_that_cannot_be_met_is_not_written)
{
    RecordingBus bus;
    dff::FpgaLens lens(bus);
    bus.transfers.clear();
    auto table = contract_table();
    table.period = 500us;
    EXPECT_THROW(lens.load(table), std::invalid_argument);
    EXPECT_TRUE(bus.transfers.empty());
}

TEST(FpgaLens, table_that_the_sequencer_refuses_is_an_error_that_says_why)
{
    RecordingBus bus;
    dff::FpgaLens lens(bus);
    bus.words[RecordingBus::number(Word::error)] = error_table_timing.mask();
    try {
        lens.load(contract_table());
        FAIL() << "not refused";
    } catch (const dff::I2cError &error) {
        EXPECT_NE(std::string(error.what()).find("times"), std::string::npos);
    }
}

TEST(FpgaLens, transfer_that_fails_twice_is_tried_a_third_time)
{
    RecordingBus bus;
    dff::FpgaLens lens(bus);
    bus.failures = 2;
    EXPECT_NO_THROW(lens.start(false));
    EXPECT_TRUE(has(bus, "write 020100"));
}

TEST(FpgaLens, transfer_that_keeps_failing_stops_the_sweep)
{
    RecordingBus bus;
    dff::FpgaLens lens(bus);
    lens.start(false);
    bus.transfers.clear();
    bus.failures = 3;
    EXPECT_THROW(lens.status(), dff::I2cError);
    EXPECT_EQ(bus.transfers, (std::vector<std::string>{"failed", "failed", "failed", "write 020000"}));
}

TEST(FpgaLens, count_that_cannot_be_read_leaves_the_sweep_alone)
{
    RecordingBus bus;
    dff::FpgaLens lens(bus);
    lens.start(false);
    bus.transfers.clear();
    bus.failures = 3;
    EXPECT_THROW(lens.frame_count(), dff::I2cError);
    EXPECT_EQ(bus.transfers, (std::vector<std::string>{"failed", "failed", "failed"}));
}

TEST(FpgaLens, dead_bus_ends_in_an_error_after_few_tries)
{
    RecordingBus bus;
    dff::FpgaLens lens(bus);
    bus.transfers.clear();
    bus.failures = 1000;
    EXPECT_THROW(lens.start(true), dff::I2cError);
    EXPECT_EQ(bus.transfers.size(), 6u);
}

TEST(FpgaLens, status_and_counters_are_put_together)
{
    RecordingBus bus;
    dff::FpgaLens lens(bus);
    bus.words[RecordingBus::number(Word::status)] =
        static_cast<std::uint16_t>(status_busy.mask() | status_failed.mask() | status_plane.place(37));
    bus.words[RecordingBus::number(Word::error)] = error_lens_nack.mask();
    bus.words[RecordingBus::number(Word::sweep_count_low)] = 0x5678;
    bus.words[RecordingBus::number(Word::sweep_count_high)] = 0x1234;
    const auto status = lens.status();
    EXPECT_TRUE(status.busy);
    EXPECT_FALSE(status.downward);
    EXPECT_EQ(status.plane, 37u);
    EXPECT_NE(dff::describe_errors(status.errors).find("does not answer"), std::string::npos);
    bus.transfers.clear();
    EXPECT_EQ(lens.sweep_count(), 0x12345678u);
    EXPECT_EQ(bus.transfers,
              (std::vector<std::string>{"read 06", "read 07"})); // the low word latches the high one
}
