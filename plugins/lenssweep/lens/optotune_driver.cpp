/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optotune_driver.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>

namespace dff {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int tries = 4;
constexpr std::chrono::milliseconds patience{150}; /* an answer takes some milliseconds */

constexpr std::string_view greeting = "Start";
constexpr std::string_view welcome = "Ready\r\n";
constexpr double codes_a_dioptre = 200.0;
constexpr double type_a_offset = 5.0;
constexpr double current_codes = 4095.0;
constexpr double degrees_a_code = 0.0625;

/* By the data sheets of EL-10-30 and EL-16-40, degrees Celsius. */
constexpr double hottest = 65.0;

/* Of the byte of errors that MwCA and PwTA answer with: no limits of temperature were set. */
constexpr std::uint8_t no_limits = 1U << 2;
/* Degrees Celsius between which a focal power can be held: those of the example in the maker's table. */
constexpr double usual_coldest = 20.0;
constexpr double usual_hottest = 45.0;
constexpr double margin = 5.0;

Bytes bytes_of(std::string_view text)
{
    return {text.begin(), text.end()};
}

void append(Bytes &bytes, std::int16_t number)
{
    const auto bits = static_cast<std::uint16_t>(number);
    bytes.push_back(static_cast<std::uint8_t>(bits >> 8));
    bytes.push_back(static_cast<std::uint8_t>(bits & 0xff));
}

std::int16_t number_at(const Bytes &bytes, std::size_t place)
{
    return static_cast<std::int16_t>(bytes.at(place) << 8 | bytes.at(place + 1));
}

Bytes with_checksum(Bytes bytes)
{
    const std::uint16_t crc = crc16_ibm(bytes);
    bytes.push_back(static_cast<std::uint8_t>(crc & 0xff));
    bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
    return bytes;
}

/* Whether these are so many bytes with their checksum and an end of line. */
bool is_answer(std::span<const std::uint8_t> bytes, std::size_t size)
{
    if (bytes.size() != size + 4 || bytes[size + 2] != '\r' || bytes[size + 3] != '\n')
        return false;
    const std::uint16_t crc = crc16_ibm(bytes.first(size));
    return bytes[size] == (crc & 0xff) && bytes[size + 1] == crc >> 8;
}

} // namespace

std::uint16_t crc16_ibm(std::span<const std::uint8_t> bytes)
{
    constexpr std::uint16_t reflected_polynomial = 0xa001;
    std::uint16_t crc = 0;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit)
            crc = static_cast<std::uint16_t>(crc & 1U ? crc >> 1 ^ reflected_polynomial : crc >> 1);
    }
    return crc;
}

OptotuneDriver::OptotuneDriver(const std::string &device) : port_(device)
{
    greet();
    offset_ = ask(bytes_of("H"), 2).at(1) == 'A' ? type_a_offset : 0.0;
    Bytes question = bytes_of("CrMA");
    append(question, 0);
    greatest_current_ = number_at(ask(question, 5), 3) / 100.0;
}

void OptotuneDriver::greet()
{
    for (int attempt = 0; attempt < tries; ++attempt) {
        port_.forget_input();
        port_.write(bytes_of(greeting));
        if (port_.read(welcome.size(), patience) == bytes_of(welcome))
            return;
    }
    throw LensError(
        "no Optotune Lens Driver answers on " + port_.device() +
        ": check that it is this port, and that its light is on. ls -l /dev/serial/by-id names those "
        "there are");
}

/* With checksum and end of line. What is asked twice is right even if the first answer came late: callers
 * look whether it is of what they set. */
OptotuneDriver::Bytes OptotuneDriver::ask(const Bytes &question, std::size_t answer_size)
{
    for (int attempt = 0; attempt < tries; ++attempt) {
        port_.forget_input();
        port_.write(with_checksum(question));
        Bytes answer = port_.read(answer_size + 4, patience);
        if (is_answer(answer, answer_size) && answer.front() == question.front())
            return answer;
    }
    throw LensError("the Optotune Lens Driver on " + port_.device() +
                    " gives no answer that can be read: check its cable, unplug it and plug it in again");
}

std::int16_t OptotuneDriver::focal_power_code(double dioptres) const
{
    return static_cast<std::int16_t>(std::lround((dioptres + offset_) * codes_a_dioptre));
}

std::int16_t OptotuneDriver::current_code(double milliamperes) const
{
    return static_cast<std::int16_t>(std::lround(milliamperes / greatest_current_ * current_codes));
}

double OptotuneDriver::focal_power_of(std::int16_t code) const
{
    return code / codes_a_dioptre - offset_;
}

OptotuneDriver::Range OptotuneDriver::enter_focal_power_mode()
{
    Bytes answer = ask(bytes_of("MwCA"), 8);
    if (answer.at(3) & no_limits) {
        set_temperature_limits();
        answer = ask(bytes_of("MwCA"), 8);
    }
    if (answer.at(3) != 0)
        throw LensError(
            "the Optotune Lens Driver on " + port_.device() +
            " cannot hold a focal power with this lens (error " + std::to_string(answer.at(3)) +
            "): it has no calibration in its memory, or is too hot. A lens-profile with unit \"mA\" drives "
            "it by current");
    return {focal_power_of(number_at(answer, 6)), focal_power_of(number_at(answer, 4))};
}

void OptotuneDriver::set_focal_power(double dioptres)
{
    const std::int16_t code = focal_power_code(dioptres);
    Bytes command = bytes_of("PwDA");
    append(command, code);
    append(command, 0);
    Bytes question = bytes_of("PrDA");
    append(question, 0);
    append(question, 0);
    for (int attempt = 0; attempt < tries; ++attempt) {
        port_.write(with_checksum(command));
        if (number_at(ask(question, 4), 2) == code)
            return;
    }
    throw LensError("the Optotune Lens Driver on " + port_.device() +
                    " does not take a focal power: does another program drive it?");
}

void OptotuneDriver::enter_current_mode()
{
    ask(bytes_of("MwDA"), 3);
}

void OptotuneDriver::set_current(double milliamperes)
{
    const std::int16_t code = current_code(milliamperes);
    Bytes command = bytes_of("Aw");
    append(command, code);
    Bytes question = bytes_of("Ar");
    append(question, 0);
    for (int attempt = 0; attempt < tries; ++attempt) {
        port_.write(with_checksum(command));
        if (number_at(ask(question, 3), 1) == code)
            return;
    }
    throw LensError("the Optotune Lens Driver on " + port_.device() +
                    " does not take a current: does another program drive it?");
}

/* A driver that was just plugged in has none, and holds no focal power then. The wider they are, the less of
 * its range can be held at all of them. */
void OptotuneDriver::set_temperature_limits()
{
    const double now = temperature();
    Bytes command = bytes_of("PwTA");
    append(command,
           static_cast<std::int16_t>(std::lround(std::max(usual_hottest, now + margin) / degrees_a_code)));
    append(command,
           static_cast<std::int16_t>(std::lround(std::min(usual_coldest, now - margin) / degrees_a_code)));
    ask(command, 7);
}

/* One of the signal's "U"pper and "L"ower currents and its "F"requency. */
void OptotuneDriver::set_signal(char property, std::uint32_t data, unsigned size)
{
    Bytes command = {'P', 'w', static_cast<std::uint8_t>(property), 'A'};
    append(command, static_cast<std::int16_t>(data >> (size == 4 ? 16 : 0)));
    append(command, static_cast<std::int16_t>(size == 4 ? data & 0xffff : 0));
    for (int attempt = 0; attempt < tries; ++attempt) {
        port_.write(with_checksum(command));
        if (signal(property, size) == data)
            return;
    }
    throw LensError("the Optotune Lens Driver on " + port_.device() +
                    " does not tell that it has taken the triangle that it was given: use mode=step");
}

/* Programs that speak to it read "MPAU" and then the number (ramzes3/Optotune-ETL-control-in-matlab), or
 * three letters and then the number (opto), and the maker's table has two or four bytes of it: kinds of
 * firmware differ. */
std::optional<std::uint32_t> OptotuneDriver::signal(char property, unsigned size)
{
    constexpr std::size_t around = 4; /* checksum and end of line */
    constexpr std::size_t longest = 4 + 4 + around;
    port_.forget_input();
    port_.write(with_checksum({'P', 'r', static_cast<std::uint8_t>(property), 'A', 0, 0, 0, 0}));
    Bytes answer = port_.read(3 + size + around, patience);
    while (!is_answer(answer, std::max(answer.size(), around) - around)) {
        const Bytes more = answer.size() < longest ? port_.read(1, patience) : Bytes{};
        if (more.empty())
            return std::nullopt;
        answer.push_back(more.front());
    }
    const std::size_t begin = answer.front() == 'M' ? 4 : 3;
    const auto letters = std::span(answer).first(begin);
    if (std::find(letters.begin(), letters.end(), property) == letters.end() ||
        begin + size + around > answer.size())
        return std::nullopt;
    std::uint32_t number = 0;
    for (std::size_t place = begin; place < begin + size; ++place)
        number = number << 8 | answer[place];
    return number;
}

/* The signal's properties can be set in its mode only. */
void OptotuneDriver::start_triangle(double lower_milliamperes, double upper_milliamperes, double hertz)
{
    ask(bytes_of("MwTA"), 3);
    set_signal('L', static_cast<std::uint16_t>(current_code(lower_milliamperes)), 2);
    set_signal('U', static_cast<std::uint16_t>(current_code(upper_milliamperes)), 2);
    set_signal('F', static_cast<std::uint32_t>(std::lround(1000 * hertz)), 4);
}

void OptotuneDriver::rest()
{
    enter_current_mode();
    set_current(0);
}

double OptotuneDriver::temperature()
{
    return number_at(ask(bytes_of("TCA"), 5), 3) * degrees_a_code;
}

void OptotuneDriver::check_temperature()
{
    const double degrees = temperature();
    if (degrees <= hottest)
        return;
    rest();
    std::ostringstream text;
    text << "the Optotune lens has " << degrees << " degrees Celsius, and " << hottest
         << " are the most it is made for: let it cool down, and use smaller powers";
    throw LensError(text.str());
}

} // namespace dff
