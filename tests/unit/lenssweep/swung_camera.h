/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "fake_optotune.h"
#include "line_server.h"

#include <chrono>
#include <functional>
#include <gst/app/gstappsrc.h>
#include <memory>
#include <string>
#include <thread>

/* What is wired to pin A of an Optotune lens driver: a line (a socket) that is high from the upper turn of
 * its triangle to the lower one, and a camera that takes so many frames from one upper turn to the next, the
 * first `delay` after it. A frame's exposure is as long as its time, and its pixels are the mA at which the
 * lens stands in its middle, by the time that it is stamped with; the lens follows the current by `lag`.
 * Every third pixel of a row is brighter, more so where what is there is sharper: in the rows above at small
 * currents, below at large ones. What is late on a busy machine comes late, and has the time it would have
 * had. */
class SwungCamera {
public:
    SwungCamera(FakeOptotune &driver, unsigned frames_a_period, std::chrono::nanoseconds lag,
                std::chrono::nanoseconds delay);
    ~SwungCamera();
    SwungCamera(const SwungCamera &) = delete;
    SwungCamera &operator=(const SwungCamera &) = delete;

    /* As sync-line has it. */
    std::string line() const { return "socket:" + path_; }

    /* Frames go there, for as long as the driver swings. */
    void shoot_into(GstAppSrc *source);
    void stop();

    static constexpr unsigned side = 48;
    static constexpr const char *caps = "video/x-raw,format=GRAY8,width=48,height=48,framerate=50/1";

private:
    void run(const std::stop_token &stop, GstAppSrc *source);
    void shoot_period(const std::stop_token &stop, GstAppSrc *source, const FakeOptotune::Triangle &triangle,
                      std::uint64_t edge_ns);
    void push(GstAppSrc *source, std::uint64_t time_ns, double current);

    FakeOptotune &driver_;
    unsigned frames_;
    std::int64_t lag_ns_;
    std::int64_t delay_ns_;
    std::string folder_;
    std::string path_;
    std::unique_ptr<dff::LineServer> pin_;
    std::jthread thread_;
};
