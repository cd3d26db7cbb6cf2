/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "line_triggers.h"

#include "camera_stream.h"
#include "counting_labeller.h"
#include "trigger_labeller.h"

#include <utility>

namespace dff {

namespace {

std::unique_ptr<PlaneLabeller> labeller_for(const SweepTiming &timing, FrameNumbers numbers,
                                            SyncRhythm *rhythm)
{
    if (rhythm)
        return std::make_unique<TriggerLabeller>(timing, numbers, *rhythm);
    return std::make_unique<CountingLabeller>(timing, numbers);
}

} // namespace

LineTriggers::LineTriggers(const SweepTiming &timing, FrameNumbers numbers, const Parts &parts,
                           std::function<void()> on_error)
    : LineTriggers(timing, numbers, parts, parts.sync ? std::make_unique<SyncRhythm>(timing) : nullptr,
                   std::move(on_error))
{
}

LineTriggers::LineTriggers(const SweepTiming &timing, FrameNumbers numbers, const Parts &parts,
                           std::unique_ptr<SyncRhythm> rhythm, std::function<void()> on_error)
    : Triggers(labeller_for(timing, numbers, rhythm.get()), std::move(on_error)), parts_(parts),
      rhythm_(std::move(rhythm))
{
    if (parts_.sync)
        listener_ = std::jthread([this](const std::stop_token &stop) { listen(stop); });
}

LineTriggers::~LineTriggers()
{
    stop();
}

void LineTriggers::listen(const std::stop_token &stop)
{
    try {
        while (!stop.stop_requested()) {
            const auto edge = parts_.sync->wait(stop, std::chrono::hours(1));
            const std::lock_guard lock(mutex_);
            const auto time_ns = edge ? static_cast<std::int64_t>(edge->time_ns) : 0;
            if (edge && time_ns >= started_ns_)
                rhythm_->edge(time_ns);
        }
    } catch (...) {
        fail();
    }
}

void LineTriggers::start()
{
    {
        const std::lock_guard lock(mutex_);
        started_ns_ = host_now_ns();
        labeller_->start(restartable() ? PlaneLabeller::Beginning::FromRest
                                       : PlaneLabeller::Beginning::UnderWay,
                         started_ns_);
    }
    if (parts_.lens) {
        count_ = parts_.lens->frame_count();
        parts_.lens->start();
    }
    if (parts_.run)
        parts_.run->set(true);
}

void LineTriggers::stop() noexcept
{
    try {
        if (parts_.run)
            parts_.run->set(false);
        if (parts_.lens) {
            parts_.lens->stop();
            count_given();
        }
    } catch (...) {
        fail();
    }
}

void LineTriggers::check()
{
    Triggers::check();
    if (!parts_.lens)
        return;
    parts_.lens->check();
    count_given();
}

void LineTriggers::count_given()
{
    if (!count_)
        return;
    const std::uint32_t now = parts_.lens->frame_count();
    const std::lock_guard lock(mutex_);
    given_ += static_cast<std::uint32_t>(now - *std::exchange(count_, now));
}

std::optional<std::uint64_t> LineTriggers::given() const
{
    if (!parts_.lens)
        return std::nullopt;
    const std::lock_guard lock(mutex_);
    return given_;
}

std::uint64_t LineTriggers::wrong_edges() const
{
    const std::lock_guard lock(mutex_);
    return rhythm_ ? rhythm_->wrong_edges() : 0;
}

} // namespace dff
