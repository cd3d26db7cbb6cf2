/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "software_triggers.h"

#include "camera_stream.h"
#include "trigger_labeller.h"

#include <algorithm>
#include <condition_variable>

namespace dff {

namespace {

/* False if stopped. */
bool sleep_until(std::int64_t time_ns, const std::stop_token &stop)
{
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    never.wait_until(lock, stop, std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time_ns)),
                     [] { return false; });
    return !stop.stop_requested();
}

} // namespace

SoftwareTriggers::SoftwareTriggers(const SweepTiming &timing, FrameNumbers numbers, CameraControl &camera,
                                   SteppedLens *lens, std::function<void()> on_error)
    : SoftwareTriggers(timing, numbers, camera, lens, std::make_unique<SentTriggers>(timing),
                       std::move(on_error))
{
}

SoftwareTriggers::SoftwareTriggers(const SweepTiming &timing, FrameNumbers numbers, CameraControl &camera,
                                   SteppedLens *lens, std::unique_ptr<SentTriggers> sent,
                                   std::function<void()> on_error)
    : Triggers(std::make_unique<TriggerLabeller>(timing, numbers, *sent), std::move(on_error)),
      timing_(timing), camera_(camera), lens_(lens), sent_(std::move(sent))
{
}

SoftwareTriggers::~SoftwareTriggers()
{
    stop();
}

void SoftwareTriggers::start()
{
    {
        const std::lock_guard lock(mutex_);
        labeller_->start(PlaneLabeller::Beginning::FromRest, host_now_ns());
    }
    if (lens_)
        lens_->start();
    next_sweep_++; /* the one before may have been broken off */
    sender_ = std::jthread([this](const std::stop_token &stop) {
        try {
            send(stop);
        } catch (...) {
            fail();
        }
    });
}

void SoftwareTriggers::stop() noexcept
{
    if (sender_.joinable()) {
        sender_.request_stop();
        sender_.join();
    }
    try {
        if (lens_)
            lens_->stop();
    } catch (...) {
        fail();
    }
}

bool SoftwareTriggers::settle(unsigned plane, const std::stop_token &stop)
{
    if (!lens_)
        return true;
    lens_->move_to(plane);
    return lens_->wait_settled(stop);
}

void SoftwareTriggers::send(const std::stop_token &stop)
{
    std::int64_t due_ns = host_now_ns();
    for (;; next_sweep_++) {
        for (unsigned plane = 0; plane < timing_.planes; plane++) {
            if (!settle(plane, stop) || !sleep_until(due_ns, stop))
                return;
            const std::int64_t now_ns = host_now_ns();
            {
                const std::lock_guard lock(mutex_);
                sent_->sent({next_sweep_ * timing_.planes + plane, now_ns});
            }
            camera_.execute("TriggerSoftware");
            due_ns = std::max(due_ns, now_ns) + timing_.period_ns;
            if (lens_ && !sleep_until(host_now_ns() + timing_.exposure_ns, stop))
                return;
        }
    }
}

} // namespace dff
