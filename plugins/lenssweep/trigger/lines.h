/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

namespace dff {

/* A GPIO line cannot be had or used. The text is for the user and says what to do. */
class LineError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/* A line that is driven, as `run-line`. */
class OutputLine {
public:
    /* Drives the line low and gives it back. */
    virtual ~OutputLine() = default;

    /* Never waits. Throws LineError. */
    virtual void set(bool high) = 0;
};

/* An edge of a line. */
struct LineEdge {
    std::uint64_t time_ns; /* CLOCK_MONOTONIC, taken by the kernel when the edge came */
};

/* A line that is listened to, as `sync-line`: its rising edges. The kernel keeps 16 of them for a reader who
 * is late, and drops those that come then. */
class EdgeLine {
public:
    /* Gives the line back. */
    virtual ~EdgeLine() = default;

    /* For poll(): it can be read once an edge has come, or the line has failed. */
    virtual int descriptor() const = 0;

    /* The next edge that has come, or nothing; never waits. Throws LineError. */
    virtual std::optional<LineEdge> read() = 0;
};

/* Takes a line, called by its name ("SYNC"), by chip and offset ("gpiochip0:5", "/dev/gpiochip0:5"), or, for
 * rigs without GPIO, by the socket of another process ("socket:/run/rig/sync", see socket_lines.h). An output
 * begins low; an edge line is pulled down, where the chip can, so that a cable that is not plugged in gives
 * no edges. Throws LineError; always for a GPIO line, in a build without libgpiod. */
std::unique_ptr<OutputLine> open_output_line(const std::string &name);
std::unique_ptr<EdgeLine> open_edge_line(const std::string &name);

} // namespace dff
