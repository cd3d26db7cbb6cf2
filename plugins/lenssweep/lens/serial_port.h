/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens_error.h"

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace dff {

/* A serial port for bytes as they are: 8 data bits, no parity, one stop bit, no flow control. */
class SerialPort {
public:
    /* Throws LensError if it cannot be opened, or another program has it. */
    explicit SerialPort(std::string device);
    ~SerialPort();
    SerialPort(const SerialPort &) = delete;
    SerialPort &operator=(const SerialPort &) = delete;

    const std::string &device() const { return device_; }

    /* Throws LensError if not all of them go out. */
    void write(std::span<const std::uint8_t> bytes);

    /* So many bytes, or those that came within the time. Throws LensError if the port is gone. */
    std::vector<std::uint8_t> read(std::size_t count, std::chrono::milliseconds patience);

    /* What has come in and was not read is forgotten. */
    void forget_input();

private:
    bool wait(short events, std::chrono::steady_clock::time_point deadline);
    [[noreturn]] void fail(const std::string &what) const;

    std::string device_;
    int descriptor_;
};

} // namespace dff
