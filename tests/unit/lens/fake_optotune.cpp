/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fake_optotune.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <fcntl.h>
#include <map>
#include <poll.h>
#include <sstream>
#include <stdexcept>
#include <termios.h>
#include <unistd.h>

namespace {

constexpr double greatest_current = 292.84;
constexpr double least_power = -1.5;
constexpr double greatest_power = 3.5;

/* The checksum by a table, which is another way than the driver's. */
unsigned checksum(const std::string &bytes)
{
    static const auto table = [] {
        std::array<unsigned, 256> made{};
        for (unsigned value = 0; value < 256; value++) {
            unsigned crc = value;
            for (int bit = 0; bit < 8; bit++)
                crc = crc & 1 ? crc / 2 ^ 0xa001 : crc / 2;
            made[value] = crc;
        }
        return made;
    }();
    unsigned crc = 0;
    for (const char byte : bytes)
        crc = crc / 256 ^ table[(crc ^ static_cast<unsigned char>(byte)) % 256];
    return crc;
}

std::string checked(std::string bytes)
{
    const unsigned crc = checksum(bytes);
    bytes += static_cast<char>(crc % 256);
    bytes += static_cast<char>(crc / 256);
    return bytes;
}

/* Lengths of commands by how they begin, without checksum. */
const std::map<std::string, size_t> lengths = {
    {"H", 1},    {"CrMA", 6}, {"MwCA", 4}, {"MwDA", 4}, {"PwDA", 8}, {"PrDA", 8},
    {"Aw", 4},   {"Ar", 4},   {"TCA", 3},  {"MwTA", 4}, {"PwTA", 8}, {"PwLA", 8},
    {"PwUA", 8}, {"PwFA", 8}, {"PrLA", 8}, {"PrUA", 8}, {"PrFA", 8}};
constexpr int no_limits = 4; /* bit 2 of the byte of errors */

int number_at(const std::string &text, size_t place)
{
    return static_cast<std::int16_t>(static_cast<unsigned char>(text[place]) << 8 |
                                     static_cast<unsigned char>(text[place + 1]));
}

std::string bytes_of(int number)
{
    return {static_cast<char>(number >> 8 & 0xff), static_cast<char>(number & 0xff)};
}

} // namespace

FakeOptotune::FakeOptotune(char firmware_type) : firmware_type_(firmware_type)
{
    master_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0)
        throw std::runtime_error("no pseudo-terminal");
    device_ = ptsname(master_);
    slave_ = open(device_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios settings{};
    tcgetattr(slave_, &settings);
    cfmakeraw(&settings);
    tcsetattr(slave_, TCSANOW, &settings);
    server_ = std::jthread([this](const std::stop_token &stop) { serve(stop); });
}

FakeOptotune::~FakeOptotune()
{
    unplug();
}

void FakeOptotune::unplug()
{
    if (!server_.joinable())
        return;
    server_.request_stop();
    server_.join();
    close(slave_);
    close(master_);
}

void FakeOptotune::lose_bytes(unsigned n)
{
    const std::lock_guard lock(mutex_);
    lost_every_ = n;
}

void FakeOptotune::answer_late(std::chrono::milliseconds delay)
{
    const std::lock_guard lock(mutex_);
    delay_ = delay;
}

void FakeOptotune::set_temperature(double degrees)
{
    const std::lock_guard lock(mutex_);
    temperature_ = degrees;
}

void FakeOptotune::refuse_focal_power()
{
    const std::lock_guard lock(mutex_);
    refuses_ = true;
}

void FakeOptotune::forget_temperature_limits()
{
    const std::lock_guard lock(mutex_);
    knows_limits_ = false;
}

void FakeOptotune::answer_with_three_letters()
{
    const std::lock_guard lock(mutex_);
    three_letters_ = true;
}

std::optional<FakeOptotune::Triangle> FakeOptotune::triangle()
{
    const std::lock_guard lock(mutex_);
    if (mode_ != 'T' || signal_.size() < 3)
        return std::nullopt;
    const auto current = [](std::uint32_t code) {
        return static_cast<std::int16_t>(code) * greatest_current / 4095;
    };
    return Triangle{current(signal_['L']), current(signal_['U']), signal_['F'] / 1000.0, signal_since_ns_};
}

std::vector<std::string> FakeOptotune::moves()
{
    const std::lock_guard lock(mutex_);
    return moves_;
}

unsigned FakeOptotune::faults()
{
    const std::lock_guard lock(mutex_);
    return faults_;
}

void FakeOptotune::serve(const std::stop_token &stop)
{
    while (!stop.stop_requested()) {
        pollfd ready{master_, POLLIN, 0};
        if (poll(&ready, 1, 5) <= 0) {
            const std::lock_guard lock(mutex_);
            input_.clear(); /* a command that stays away for so long is none */
            continue;
        }
        char part[64];
        const ssize_t count = read(master_, part, sizeof part);
        const std::lock_guard lock(mutex_);
        for (ssize_t k = 0; k < count; k++) {
            if (lost_every_ == 0 || ++bytes_ % lost_every_ != 0)
                input_ += part[k];
        }
        while (take_command()) {
        }
    }
}

/* Whether there was a whole command. */
bool FakeOptotune::take_command()
{
    if (input_.starts_with("Start")) {
        input_.erase(0, 5);
        send("Ready\r\n");
        return true;
    }
    for (const auto &[begin, length] : lengths) {
        if (!input_.starts_with(begin) || input_.size() < length + 2)
            continue;
        const std::string command = input_.substr(0, length);
        const bool whole = checked(command) == input_.substr(0, length + 2);
        input_.erase(0, whole ? length + 2 : input_.size());
        faults_ += !whole;
        if (whole)
            do_command(command);
        return true;
    }
    return false;
}

void FakeOptotune::note(double value, const char *unit)
{
    std::ostringstream text;
    text << std::round(value * 1000) / 1000 << " " << unit;
    moves_.push_back(text.str());
}

void FakeOptotune::do_command(const std::string &command)
{
    const double offset = firmware_type_ == 'A' ? 5 : 0;
    const auto code_of = [offset](double power) {
        return static_cast<int>(std::lround((power + offset) * 200));
    };
    if (command == "H")
        answer("H", {firmware_type_});
    else if (command.starts_with("CrMA"))
        answer("CMA", bytes_of(static_cast<int>(greatest_current * 100)));
    else if (command == "MwCA") {
        const int errors = (refuses_ ? 1 : 0) | (knows_limits_ ? 0 : no_limits);
        mode_ = errors ? mode_ : 'C';
        answer("MCA", std::string(1, static_cast<char>(errors)) + bytes_of(code_of(greatest_power)) +
                          bytes_of(code_of(least_power)));
    } else if (command == "MwDA") {
        mode_ = 'D';
        answer("MDA");
    } else if (command.starts_with("PwDA") && mode_ == 'C') {
        focal_power_code_ = number_at(command, 4);
        note(focal_power_code_ / 200.0 - offset, "D");
    } else if (command.starts_with("PrDA"))
        answer("PD", bytes_of(focal_power_code_));
    else if (command.starts_with("Aw") && mode_ == 'D') {
        current_code_ = number_at(command, 2);
        note(current_code_ * greatest_current / 4095, "mA");
    } else if (command.starts_with("Ar"))
        answer("A", bytes_of(current_code_));
    else if (command == "TCA")
        answer("TCA", bytes_of(static_cast<int>(std::lround(temperature_ / 0.0625))));
    else
        do_signal_command(command);
}

void FakeOptotune::do_signal_command(const std::string &command)
{
    const char letter = command.at(2);
    if (command == "MwTA") {
        mode_ = 'T';
        answer("MTA");
    } else if (command.starts_with("PwTA")) {
        knows_limits_ = number_at(command, 4) > number_at(command, 6);
        answer("PT", std::string(5, '\0'));
    } else if (command.starts_with("Pw") && mode_ == 'T') {
        signal_[letter] = static_cast<std::uint16_t>(number_at(command, 4));
        if (letter == 'F')
            signal_[letter] = signal_[letter] << 16 | static_cast<std::uint16_t>(number_at(command, 6));
        signal_since_ns_ = static_cast<std::uint64_t>(
            std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count());
    } else if (command.starts_with("Pr")) {
        const std::string low = bytes_of(static_cast<int>(signal_[letter] & 0xffff));
        const std::string high = bytes_of(static_cast<int>(signal_[letter] >> 16));
        std::string begin = three_letters_ ? "P_A" : "MPA_";
        begin[begin.find('_')] = letter;
        const std::string unused = three_letters_ ? std::string(2, '\0') : "";
        answer(begin, (letter == 'F' ? high + low : low + unused));
    }
}

void FakeOptotune::answer(std::string letters, const std::string &data)
{
    send(checked(letters.append(data)).append("\r\n"));
}

void FakeOptotune::send(const std::string &bytes)
{
    std::this_thread::sleep_for(delay_);
    std::string kept;
    for (const char byte : bytes)
        if (lost_every_ == 0 || ++bytes_ % lost_every_ != 0)
            kept += byte;
    [[maybe_unused]] const ssize_t count = write(master_, kept.data(), kept.size());
}
