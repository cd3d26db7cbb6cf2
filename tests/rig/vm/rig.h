/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

/* What the virtual machine has; guest.sh brings it up. */
namespace rig {

constexpr unsigned run_line = 0;
constexpr unsigned sync_line = 1;

inline std::string variable(const char *name)
{
    const char *value = std::getenv(name);
    return value ? value : "";
}

inline std::string read_file(const std::string &path)
{
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

inline void write_file(const std::string &path, const std::string &text)
{
    std::ofstream(path) << text << std::flush;
}

/* The level that a line has. */
inline bool level(unsigned line)
{
    return read_file(variable("RIG_LINES") + "/sim_gpio" + std::to_string(line) + "/value").starts_with("1");
}

/* Drives a line that is an input, from outside. */
inline void pull(unsigned line, bool up)
{
    write_file(variable("RIG_LINES") + "/sim_gpio" + std::to_string(line) + "/pull",
               up ? "pull-up" : "pull-down");
}

inline std::string i2c_bus()
{
    return variable("RIG_I2C");
}

/* Registers written on the I2C bus since the log was emptied: "77 09=02". */
inline std::vector<std::string> i2c_log()
{
    std::istringstream text(read_file("/proc/rig_i2c"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);)
        lines.push_back(line);
    return lines;
}

inline void empty_i2c_log()
{
    write_file("/proc/rig_i2c", "empty");
}

/* What the lens driver was told, and when. */
struct Commit {
    uint64_t time_ns; /* CLOCK_MONOTONIC */
    int code;
};

inline std::vector<Commit> lens_commits()
{
    std::istringstream text(read_file("/proc/rig_lens"));
    std::vector<Commit> commits;
    for (Commit commit{}; text >> commit.time_ns >> commit.code;)
        commits.push_back(commit);
    return commits;
}

/* The next transfers are not acknowledged. */
inline void fail_i2c_transfers(int count)
{
    write_file("/sys/module/rig_i2c/parameters/nack", std::to_string(count));
}

/* Codes that the log shows committed to the lens, in order. */
inline std::vector<int> committed_codes()
{
    std::vector<int> codes;
    int low = 0;
    int high = 0;
    for (const auto &line : i2c_log()) {
        const int value = std::stoi(line.substr(line.find('=') + 1), nullptr, 16);
        if (line.starts_with("77 04="))
            low = value >> 6;
        else if (line.starts_with("77 08="))
            high = value;
        else if (line == "77 09=02")
            codes.push_back(high << 2 | low);
    }
    return codes;
}

} // namespace rig
