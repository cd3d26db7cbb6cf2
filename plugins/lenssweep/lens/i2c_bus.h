/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens_error.h"

#include <cstdint>
#include <span>

namespace dff {

/* A transfer that the other side did not acknowledge, or that the adapter could not do. */
class I2cError : public LensError {
public:
    using LensError::LensError;
};

/* One slave on an I2C bus, by the SMBus protocols that lenses speak. Every call throws I2cError. */
class I2cBus {
public:
    virtual ~I2cBus() = default;

    /* SMBus read byte data and write byte data. */
    virtual std::uint8_t read_byte(std::uint8_t command) = 0;
    virtual void write_byte(std::uint8_t command, std::uint8_t value) = 0;

    /* SMBus read word: 16 bits, low byte first. */
    virtual std::uint16_t read_word(std::uint8_t command) = 0;

    /* SMBus write word: 16 bits, low byte first. */
    virtual void write_word(std::uint8_t command, std::uint16_t value) = 0;

    /* SMBus block write: the byte count, then 1 to 32 bytes. */
    virtual void write_block(std::uint8_t command, std::span<const std::uint8_t> bytes) = 0;
};

} // namespace dff
