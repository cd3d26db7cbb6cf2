/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "serial_port.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dff {

/* CRC-16-IBM (polynomial 0x8005, reflected, from 0), as it goes over the line: low byte first. */
std::uint16_t crc16_ibm(std::span<const std::uint8_t> bytes);

/* The Lens Driver 4 and 4i of Optotune, by its serial protocol: text "Start" is answered "Ready"; a command
 * of letters, numbers with the high byte first, and a checksum is answered likewise, with an end of line. The
 * facts are those of the maker's Lens Driver 4 manual (of 2014, 2016 and 2019), of the maker's table of
 * commands (both are kept in ramzes3/Optotune-ETL-control-in-matlab on GitHub) and of free programs that
 * speak it: OrganicIrradiation/opto, elhananby/optotune-lens, funalab/LensDriver and
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

    /* From now on the current goes to and fro between these, on straight lines, so often a second. While it
     * does, pin A of the driver is high from the upper turn to the lower one (manual of 2016, section 4.7).
     */
    void start_triangle(double lower_milliamperes, double upper_milliamperes, double hertz);
    static constexpr Range triangle_hertz{0.2, 2000.0};

    /* Without current. */
    void rest();

    /* Throws LensError, and leaves the lens at rest, if it is hotter than its kind is made for. */
    void check_temperature();

private:
    using Bytes = std::vector<std::uint8_t>;

    void greet();
    Bytes ask(const Bytes &question, std::size_t answer_size);
    void set_temperature_limits();
    double temperature();
    void set_signal(char property, std::uint32_t data, unsigned size);
    std::optional<std::uint32_t> signal(char property, unsigned size);
    double focal_power_of(std::int16_t code) const;

    SerialPort port_;
    double offset_ = 0; /* dioptres, which drivers of firmware type A add */
    double greatest_current_ = 0;
};

} // namespace dff
