/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sensor.h"

#include "camera_clock.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace dff {

Sensor::Sensor(const SensorTraits &traits, const FaultSettings &faults, Report &report)
    : traits_(traits), report_(report), faults_(faults), frame_id_(traits.first_frame_id)
{
}

void Sensor::set(const ExposureSettings &settings)
{
    const std::scoped_lock lock(mutex_);
    settings_ = settings;
}

void Sensor::drop_frames()
{
    report_.unsent += static_cast<uint64_t>(std::count_if(
        frames_.begin(), frames_.end(), [](const Exposure &frame) { return !frame.duplicate; }));
    report_.unsent += held_ ? 1 : 0;
    frames_.clear();
    held_.reset();
}

void Sensor::start_acquisition()
{
    const std::scoped_lock lock(mutex_);
    drop_frames();
    acquiring_ = true;
    busy_until_ns_ = 0;
    if (traits_.restart_ids)
        frame_id_ = 1;
    report_.acquisitions++;
}

void Sensor::stop_acquisition()
{
    const std::scoped_lock lock(mutex_);
    drop_frames();
    acquiring_ = false;
}

uint16_t Sensor::next_id()
{
    const uint16_t id = frame_id_;
    frame_id_ = id == UINT16_MAX ? 1 : static_cast<uint16_t>(id + 1);
    return id;
}

void Sensor::expose(uint64_t time_ns, const LensPosition &lens)
{
    const std::scoped_lock lock(mutex_);
    if (!acquiring_) {
        report_.unheard++;
        return;
    }
    if (time_ns < busy_until_ns_) {
        report_.missed++;
        return;
    }
    const Fault fault = faults_.next();
    if (fault.ignore) {
        report_.ignored++;
        return;
    }
    const uint64_t exposed_ns = time_ns + settings_.exposure_ns;
    busy_until_ns_ = settings_.overlap ? exposed_ns : exposed_ns + traits_.readout_ns;
    report_.exposed++;
    enqueue({time_ns, exposed_ns + traits_.readout_ns, next_id(), lens}, fault);
    changed_.notify_all();
}

void Sensor::enqueue(const Exposure &exposure, const Fault &fault)
{
    if (fault.lose) {
        report_.lost++;
        report_.add_lost_id(exposure.frame_id);
        return;
    }
    Exposure frame = exposure;
    frame.ready_ns += fault.delay ? faults_.delay_ns() : 0;
    if (fault.hold && !held_) {
        report_.late++;
        held_ = frame;
        return;
    }
    frames_.push_back(frame);
    if (held_)
        frames_.push_back(*std::exchange(held_, std::nullopt));
    if (fault.duplicate) {
        frame.duplicate = true;
        frames_.push_back(frame);
    }
}

std::optional<Exposure> Sensor::next_frame(uint64_t timeout_ns)
{
    const uint64_t end_ns = monotonic_ns() + timeout_ns;
    std::unique_lock lock(mutex_);
    for (uint64_t now = monotonic_ns(); now < end_ns; now = monotonic_ns()) {
        if (!frames_.empty() && frames_.front().ready_ns <= now)
            break;
        const uint64_t wait_ns =
            (frames_.empty() ? end_ns : std::min(end_ns, frames_.front().ready_ns)) - now;
        changed_.wait_for(lock, std::chrono::nanoseconds(wait_ns));
    }
    if (frames_.empty() || frames_.front().ready_ns > monotonic_ns())
        return std::nullopt;
    const Exposure frame = frames_.front();
    frames_.pop_front();
    (frame.duplicate ? report_.duplicates : report_.sent)++;
    return frame;
}

} // namespace dff
