/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "i2c_bus.h"

#include <string>

namespace dff {

/* A slave behind Linux' i2c-dev. Uses the SMBus ioctl only, which every adapter and i2c-stub know. */
class LinuxI2cBus : public I2cBus {
public:
    /* Opens e.g. "/dev/i2c-1" for the slave with this 7-bit address; throws I2cError and says what to do. */
    LinuxI2cBus(const std::string &device, std::uint8_t address);
    ~LinuxI2cBus() override;
    LinuxI2cBus(const LinuxI2cBus &) = delete;
    LinuxI2cBus &operator=(const LinuxI2cBus &) = delete;

    std::uint8_t read_byte(std::uint8_t command) override;
    void write_byte(std::uint8_t command, std::uint8_t value) override;
    std::uint16_t read_word(std::uint8_t command) override;
    void write_word(std::uint8_t command, std::uint16_t value) override;
    void write_block(std::uint8_t command, std::span<const std::uint8_t> bytes) override;

private:
    void transfer(bool read, std::uint8_t command, std::uint32_t size, void *data, const char *what);

    std::string device_;
    std::uint8_t address_;
    int descriptor_ = -1;
};

} // namespace dff
