/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "line_triggers.h"

#include "camera_stream.h"
#include "counting_labeller.h"
#include "trigger_labeller.h"

#include <utility>

namespace dff {

namespace {

constexpr std::int64_t check_period_ns = 1'000'000'000;

std::unique_ptr<PlaneLabeller> labeller_for(const SweepTiming &timing, FrameNumbers numbers,
                                            SyncRhythm *rhythm, const TriggerCount *count)
{
    if (rhythm)
        return std::make_unique<TriggerLabeller>(timing, numbers, *rhythm, count);
    return std::make_unique<CountingLabeller>(timing, numbers);
}

} // namespace

LineTriggers::LineTriggers(const SweepTiming &timing, FrameNumbers numbers, const Parts &parts,
                           std::function<void()> on_error)
    : LineTriggers(timing, numbers, parts,
                   {parts.sync ? std::make_unique<SyncRhythm>(timing) : nullptr,
                    parts.lens ? std::make_unique<TriggerCount>(timing) : nullptr},
                   std::move(on_error))
{
}

LineTriggers::LineTriggers(const SweepTiming &timing, FrameNumbers numbers, const Parts &parts,
                           Witnesses witnesses, std::function<void()> on_error)
    : Triggers(labeller_for(timing, numbers, witnesses.rhythm.get(), witnesses.count.get()),
               std::move(on_error)),
      timing_(timing), parts_(parts), witnesses_(std::move(witnesses))
{
    if (parts_.sync)
        listener_ = std::jthread([this](const std::stop_token &stop) { listen(stop); });
    if (parts_.lens)
        watcher_ = std::jthread([this](const std::stop_token &stop) { watch_lens(stop); });
}

LineTriggers::~LineTriggers()
{
    stop();
}

/* The count is read in the middle of plane 0's period, where no trigger falls. */
void LineTriggers::listen(const std::stop_token &stop)
{
    try {
        while (!stop.stop_requested()) {
            const auto edge = parts_.sync->wait(stop, std::chrono::hours(1));
            const std::lock_guard lock(mutex_);
            const auto time_ns = edge ? static_cast<std::int64_t>(edge->time_ns) : 0;
            if (!edge || time_ns < started_ns_ || !witnesses_.rhythm->edge(time_ns))
                continue;
            read_at_ = time_ns + timing_.period_ns / 2;
            wanted_.notify_all();
        }
    } catch (...) {
        fail();
    }
}

/* A check is due each second, a reading when an edge asks for it. */
void LineTriggers::wait_for_reading(const std::stop_token &stop)
{
    using Time = std::chrono::steady_clock::time_point;
    std::unique_lock lock(mutex_);
    wanted_.wait_for(lock, stop, std::chrono::nanoseconds(check_period_ns),
                     [this] { return read_at_.has_value(); });
    const auto at = std::exchange(read_at_, std::nullopt);
    if (at)
        wanted_.wait_until(lock, stop, Time(std::chrono::nanoseconds(*at)), [] { return false; });
}

void LineTriggers::watch_lens(const std::stop_token &stop)
{
    try {
        while (!stop.stop_requested()) {
            wait_for_reading(stop);
            check_lens();
        }
    } catch (...) {
        fail();
    }
}

void LineTriggers::check_lens()
{
    const std::lock_guard lens_lock(lens_mutex_);
    if (!started_)
        return;
    take_count(witnesses_.rhythm.get());
    const std::int64_t now_ns = host_now_ns();
    if (now_ns < next_check_ns_)
        return;
    next_check_ns_ = now_ns + check_period_ns;
    parts_.lens->check();
}

/* The lens is locked. */
std::optional<CountReading> LineTriggers::read_count()
{
    try {
        const std::int64_t before_ns = host_now_ns();
        const std::uint32_t count = parts_.lens->frame_count();
        return CountReading{count, before_ns, host_now_ns()};
    } catch (const LensError &error) {
        const std::lock_guard lock(mutex_);
        if (!std::exchange(complained_, true))
            complaint_ = error.what();
        return std::nullopt;
    }
}

/* The lens is locked. */
void LineTriggers::take_count(const TriggerTimes *triggers)
{
    const auto reading = read_count();
    const std::lock_guard lock(mutex_);
    if (reading)
        witnesses_.count->read(*reading, triggers);
    else
        witnesses_.count->withdraw();
}

void LineTriggers::start()
{
    const std::lock_guard lens_lock(lens_mutex_);
    const auto at_rest = parts_.lens ? read_count() : std::nullopt;
    {
        const std::lock_guard lock(mutex_);
        started_ns_ = host_now_ns();
        labeller_->start(restartable() ? PlaneLabeller::Beginning::FromRest
                                       : PlaneLabeller::Beginning::UnderWay,
                         started_ns_);
        if (witnesses_.count)
            witnesses_.count->restart(at_rest ? std::optional(at_rest->count) : std::nullopt);
    }
    if (parts_.lens)
        parts_.lens->start();
    started_ = true;
    if (parts_.run)
        parts_.run->set(true);
}

void LineTriggers::stop() noexcept
{
    const std::lock_guard lens_lock(lens_mutex_);
    try {
        if (parts_.run)
            parts_.run->set(false);
        if (parts_.lens)
            parts_.lens->stop();
        if (parts_.lens && started_)
            take_count(nullptr); /* it rests, and the edges do not know */
    } catch (...) {
        fail();
    }
    started_ = false;
}

std::optional<std::uint64_t> LineTriggers::given() const
{
    const std::lock_guard lock(mutex_);
    return witnesses_.count ? std::optional(witnesses_.count->given()) : std::nullopt;
}

std::uint64_t LineTriggers::wrong_counts() const
{
    const std::lock_guard lock(mutex_);
    return witnesses_.count ? witnesses_.count->wrong() : 0;
}

std::string LineTriggers::take_complaint()
{
    const std::lock_guard lock(mutex_);
    return std::exchange(complaint_, {});
}

std::uint64_t LineTriggers::wrong_edges() const
{
    const std::lock_guard lock(mutex_);
    return witnesses_.rhythm ? witnesses_.rhythm->wrong_edges() : 0;
}

} // namespace dff
