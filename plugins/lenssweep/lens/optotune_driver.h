/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "serial_port.h"

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace dff {

/* CRC-16-IBM (polynomial 0x8005, reflected, from 0), as it goes over the line: low byte first. */
std::uint16_t crc16_ibm(std::span<const std::uint8_t> bytes);

/* The Lens Driver 4 and 4i of Optotune, by its serial protocol: text "Start" is answered "Ready"; a command
 * of letters, numbers of 16 bits with the high byte first, and a checksum is answered likewise, with an end
 * of line. The facts are those of the maker's Lens Driver 4 manual (of 2014, 15 to 17, and of 2019) and of
 * free programs that speak it: OrganicIrradiation/opto, elhananby/optotune-lens and
 * uedatatsu/OptotuneLensDriver4i_Controller on GitHub.
 *
 * Commands that are not answered ("Aw", "PwDA" among them) are followed by a question that is, so that what
 * got lost is seen. A question that is not answered, or wrongly, is asked again a few times; then LensError
 * is thrown with what to do. */
class OptotuneDriver {
public:
    struct Range {
        double least;
        double greatest;
    };

    /* Greets the driver. Throws LensError if nobody answers, or somebody else. */
    explicit OptotuneDriver(const std::string &device);

    /* mA that it gives at most, either way. */
    double greatest_current() const { return greatest_current_; }

    /* What it is told for them. */
    std::int16_t focal_power_code(double dioptres) const;
    std::int16_t current_code(double milliamperes) const;

    /* The lens is to hold its focal power whatever its temperature, which it can between these dioptres. */
    Range enter_focal_power_mode();
    void set_focal_power(double dioptres);

    void enter_current_mode();
    void set_current(double milliamperes);

    /* Of the lens, in degrees Celsius. */
    double temperature();

private:
    using Bytes = std::vector<std::uint8_t>;

    void greet();
    Bytes ask(const Bytes &question, std::size_t answer_size);
    double focal_power_of(std::int16_t code) const;

    SerialPort port_;
    double offset_ = 0; /* dioptres, which drivers of firmware type A add */
    double greatest_current_ = 0;
};

} // namespace dff
