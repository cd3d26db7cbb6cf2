/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <sys/types.h>
#include <vector>

namespace dff {

/* The bench camera as a process beside this one. */
class BenchProcess {
public:
    using Counts = std::map<std::string, int64_t>;

    /* Returns once the camera can be used. Throws std::runtime_error. */
    explicit BenchProcess(const std::vector<std::string> &options);
    ~BenchProcess();
    BenchProcess(const BenchProcess &) = delete;
    BenchProcess &operator=(const BenchProcess &) = delete;

    /* lenssweepsrc, called "source", with this camera; and with its lines. */
    std::string unwired_source() const;
    std::string source() const;

    std::string truth() const { return folder_ / "truth.png"; }

    /* Ends it; what it did. */
    Counts stop();

    /* Its plug is pulled; and put in again, with the same options. */
    void kill();
    void start();

private:
    std::string read_line() const;
    void end(int signal);

    std::filesystem::path folder_;
    std::vector<std::string> options_;
    pid_t pid_ = 0;
    int output_ = -1;
};

} // namespace dff
