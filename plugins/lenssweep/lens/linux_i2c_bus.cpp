/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "linux_i2c_bus.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <sys/ioctl.h>
#include <system_error>
#include <unistd.h>

namespace dff {

namespace {

std::string reason()
{
    return std::generic_category().message(errno);
}

std::string hex(unsigned value)
{
    char text[8];
    std::snprintf(text, sizeof text, "0x%02x", value);
    return text;
}

} // namespace

LinuxI2cBus::LinuxI2cBus(const std::string &device, std::uint8_t address) : device_(device), address_(address)
{
    descriptor_ = open(device.c_str(), O_RDWR | O_CLOEXEC);
    if (descriptor_ < 0) {
        throw I2cError("cannot open " + device + ": " + reason() +
                       ". Load the module i2c-dev, and let this user read and write the device");
    }
    if (ioctl(descriptor_, I2C_SLAVE, static_cast<unsigned long>(address)) < 0) {
        const std::string why = reason();
        close(descriptor_);
        throw I2cError("cannot use address " + hex(address) + " of " + device + ": " + why);
    }
}

LinuxI2cBus::~LinuxI2cBus()
{
    close(descriptor_);
}

void LinuxI2cBus::transfer(bool read, std::uint8_t command, std::uint32_t size, void *data, const char *what)
{
    i2c_smbus_ioctl_data request{};
    request.read_write = read ? I2C_SMBUS_READ : I2C_SMBUS_WRITE;
    request.command = command;
    request.size = size;
    request.data = static_cast<i2c_smbus_data *>(data);
    if (ioctl(descriptor_, I2C_SMBUS, &request) < 0) {
        throw I2cError(std::string("cannot ") + what + " " + hex(command) + " of " + device_ + " at " +
                       hex(address_) + ": " + reason());
    }
}

std::uint8_t LinuxI2cBus::read_byte(std::uint8_t command)
{
    i2c_smbus_data data{};
    transfer(true, command, I2C_SMBUS_BYTE_DATA, &data, "read byte");
    return data.byte;
}

void LinuxI2cBus::write_byte(std::uint8_t command, std::uint8_t value)
{
    i2c_smbus_data data{};
    data.byte = value;
    transfer(false, command, I2C_SMBUS_BYTE_DATA, &data, "write byte");
}

std::uint16_t LinuxI2cBus::read_word(std::uint8_t command)
{
    i2c_smbus_data data{};
    transfer(true, command, I2C_SMBUS_WORD_DATA, &data, "read word");
    return data.word;
}

void LinuxI2cBus::write_word(std::uint8_t command, std::uint16_t value)
{
    i2c_smbus_data data{};
    data.word = value;
    transfer(false, command, I2C_SMBUS_WORD_DATA, &data, "write word");
}

void LinuxI2cBus::write_block(std::uint8_t command, std::span<const std::uint8_t> bytes)
{
    if (bytes.empty() || bytes.size() > I2C_SMBUS_BLOCK_MAX) {
        throw I2cError("an SMBus block has 1 to 32 bytes, not " + std::to_string(bytes.size()));
    }
    i2c_smbus_data data{};
    data.block[0] = static_cast<std::uint8_t>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), data.block + 1);
    transfer(false, command, I2C_SMBUS_BLOCK_DATA, &data, "write block");
}

} // namespace dff
