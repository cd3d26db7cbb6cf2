/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "i2c_bus.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

/* A bus whose transfers are kept, and fail as often as is asked for. Shared with the test by reference, since
 * a lens owns its bus. */
struct I2cRecord {
    std::map<unsigned, unsigned> values; /* read back: byte or word by command */
    std::vector<std::string> transfers;  /* "b03=03": byte 3 to register 3; "w02=0001"; "b00?": read */
    int failures = 0;                    /* of the next transfers */
    int fails_after = -1;                /* transfers until all fail; -1: none do */
};

class FakeI2cBus : public dff::I2cBus {
public:
    explicit FakeI2cBus(I2cRecord &record) : record_(record) {}

    std::uint8_t read_byte(std::uint8_t command) override
    {
        note(std::string("b") + hex(command, 2) + "?");
        return static_cast<std::uint8_t>(record_.values[command]);
    }
    void write_byte(std::uint8_t command, std::uint8_t value) override
    {
        note(std::string("b") + hex(command, 2) + "=" + hex(value, 2));
    }
    std::uint16_t read_word(std::uint8_t command) override
    {
        note(std::string("w") + hex(command, 2) + "?");
        return static_cast<std::uint16_t>(record_.values[command]);
    }
    void write_word(std::uint8_t command, std::uint16_t value) override
    {
        note(std::string("w") + hex(command, 2) + "=" + hex(value, 4));
    }
    void write_block(std::uint8_t command, std::span<const std::uint8_t> bytes) override
    {
        std::string text = std::string("block") + hex(command, 2) + "=";
        for (const auto byte : bytes)
            text += hex(byte, 2);
        note(text);
    }

private:
    static std::string hex(unsigned value, int digits)
    {
        static const char *const symbols = "0123456789abcdef";
        std::string text;
        for (int i = digits - 1; i >= 0; --i)
            text += symbols[value >> 4 * i & 15U];
        return text;
    }

    void note(const std::string &transfer)
    {
        const bool dead = record_.fails_after == 0;
        if (record_.fails_after > 0)
            --record_.fails_after;
        if (dead || record_.failures > 0) {
            record_.failures -= record_.failures > 0;
            record_.transfers.push_back("failed");
            throw dff::I2cError("no acknowledge");
        }
        record_.transfers.push_back(transfer);
    }

    I2cRecord &record_;
};
