/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sequencer.h"

#include <chrono>
#include <cmath>

namespace dff {

namespace {

using Time = std::chrono::steady_clock::time_point;

Time::duration seconds(double count)
{
    return std::chrono::duration_cast<Time::duration>(std::chrono::duration<double>(count));
}

uint64_t nanoseconds(Time time)
{
    return static_cast<uint64_t>(std::chrono::nanoseconds(time.time_since_epoch()).count());
}

} // namespace

Sequencer::Sequencer(const SequencerSettings &settings, Outputs outputs)
    : settings_(settings), outputs_(std::move(outputs)),
      thread_([this](const std::stop_token &stop) { work(stop); })
{
}

Sequencer::~Sequencer()
{
    thread_.request_stop();
    thread_.join();
}

void Sequencer::set_run(bool run)
{
    const std::scoped_lock lock(mutex_);
    run_ = run;
    changed_.notify_all();
}

void Sequencer::work(const std::stop_token &stop)
{
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        if (changed_.wait(lock, stop, [this] { return run_; }))
            sweep_while_running(lock, stop);
        changed_.wait(lock, stop, [this] { return !run_; });
    }
}

void Sequencer::pulse(uint64_t count, uint64_t time_ns)
{
    const Trigger trigger{time_ns, next_sweep_, static_cast<unsigned>(count % settings_.planes)};
    if (trigger.plane == 0)
        outputs_.sync(trigger.time_ns);
    outputs_.trigger(trigger);
    if (trigger.plane == settings_.planes - 1)
        next_sweep_++;
}

void Sequencer::sweep_while_running(std::unique_lock<std::mutex> &lock, const std::stop_token &stop)
{
    /* Whole microseconds, which is what the FPGA counts in. */
    const double period = std::floor(1e6 / (settings_.rate * settings_.planes)) * 1e-6;
    const Time begin = std::chrono::steady_clock::now();
    bool broken_off = false;
    for (uint64_t count = 0; !settings_.sweeps || count < *settings_.sweeps * settings_.planes; count++) {
        double at = static_cast<double>(count) * period;
        if (settings_.pause_for > 0.0 && at >= settings_.pause_at)
            at += settings_.pause_for;
        const Time time = begin + seconds(at);
        if (changed_.wait_until(lock, stop, time, [this] { return !run_; }) || stop.stop_requested())
            break;
        lock.unlock();
        pulse(count, nanoseconds(time));
        lock.lock();
        broken_off = (count + 1) % settings_.planes != 0;
    }
    if (broken_off)
        next_sweep_++;
}

} // namespace dff
