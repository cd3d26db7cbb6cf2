/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "fault_plan.h"
#include "report.h"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

namespace dff {

/* Where the lens stands. */
struct LensPosition {
    uint64_t sweep = 0;
    unsigned plane = 0;
};

/* How the client has set the exposures up. */
struct ExposureSettings {
    uint64_t exposure_ns = 6'000'000;
    bool overlap = false; /* one frame is read out while the next is exposed */
};

/* One picture on its way to the client. */
struct Exposure {
    uint64_t start_ns; /* CLOCK_MONOTONIC */
    uint64_t ready_ns; /* to be sent */
    uint16_t frame_id;
    LensPosition lens;
    bool duplicate = false;
};

struct SensorTraits {
    uint16_t first_frame_id = 65400;
    bool restart_ids = false; /* with each acquisition */
    uint64_t readout_ns = 1'000'000;
};

/* Exposes when it is triggered, counts its frames as GigE Vision cameras do (16 bits, never 0), and hands
 * them out in the order in which they are to be sent. Any thread may call. */
class Sensor {
public:
    Sensor(const SensorTraits &traits, const FaultSettings &faults, Report &report);

    void set(const ExposureSettings &settings);

    void start_acquisition();
    void stop_acquisition();

    /* An exposure begins, unless the sensor is busy or stands still. */
    void expose(uint64_t time_ns, const LensPosition &lens);

    /* Waits until a frame can be sent, `timeout_ns` at most. */
    std::optional<Exposure> next_frame(uint64_t timeout_ns);

private:
    uint16_t next_id();
    void enqueue(const Exposure &exposure, const Fault &fault);
    void drop_frames();

    const SensorTraits traits_;
    Report &report_;
    std::mutex mutex_; /* guards all below; nothing is locked within */
    std::condition_variable changed_;
    FaultPlan faults_;
    ExposureSettings settings_;
    bool acquiring_ = false;
    uint16_t frame_id_;
    uint64_t busy_until_ns_ = 0;
    std::deque<Exposure> frames_;
    std::optional<Exposure> held_; /* to be sent after the next */
};

} // namespace dff
