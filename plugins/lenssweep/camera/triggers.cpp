/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "triggers.h"

#include "capture_poll.h"
#include "plane_labeller.h"
#include "trigger_labeller.h"

#include <algorithm>
#include <utility>

namespace dff {

namespace {

constexpr std::int64_t check_period_ns = 1'000'000'000;

/* Edges taken in one go; frames are looked at between, whatever noise there is on the line. */
constexpr int most_edges = 64;

std::unique_ptr<PlaneLabeller> labeller_for(const SweepTiming &timing, FrameNumbers numbers,
                                            SyncRhythm *rhythm, const TriggerCount *count)
{
    if (rhythm)
        return std::make_unique<TriggerLabeller>(timing, numbers, *rhythm, count);
    return std::make_unique<CountingLabeller>(timing, numbers);
}

/* What it throws is kept, for the next hear(). */
template <typename Action> void attempt(Action action, std::exception_ptr &error) noexcept
{
    try {
        action();
    } catch (...) {
        error = std::current_exception();
    }
}

void throw_if(std::exception_ptr error)
{
    if (error)
        std::rethrow_exception(std::move(error));
}

} // namespace

FreeRun::FreeRun(const SweepTiming &timing, FrameNumbers numbers)
    : Triggers(std::make_unique<CountingLabeller>(timing, numbers, CountingLabeller::Counts::FreeRun))
{
}

LineTriggers::LineTriggers(const SweepTiming &timing, FrameNumbers numbers, const Parts &parts,
                           std::function<void()> on_news)
    : Triggers(nullptr), timing_(timing), parts_(parts),
      rhythm_(parts.sync ? std::make_unique<SyncRhythm>(timing) : nullptr),
      count_(parts.lens ? std::make_unique<TriggerCount>(timing) : nullptr), lens_thread_(std::move(on_news))
{
    labeller_ = labeller_for(timing, numbers, rhythm_.get(), count_.get());
}

void LineTriggers::start()
{
    LensNews at_rest;
    if (parts_.lens)
        at_rest = read_count();
    const std::int64_t now_ns = host_now_ns();
    labeller_->start(restartable() ? PlaneLabeller::Beginning::FromRest : PlaneLabeller::Beginning::UnderWay,
                     now_ns);
    started_ns_ = now_ns;
    if (parts_.lens) {
        const auto reading = take(at_rest);
        count_->restart(reading ? std::optional(reading->count) : std::nullopt);
        parts_.lens->start();
        lens_thread_.start([this](const std::stop_token &stop) { watch_lens(stop); });
    }
    if (parts_.run)
        parts_.run->set(true);
}

/* What can be stopped is, whatever else fails. */
void LineTriggers::stop() noexcept
{
    if (parts_.run)
        attempt([this] { parts_.run->set(false); }, error_);
    lens_thread_.stop();
    if (parts_.lens)
        attempt([this] { rest_lens(); }, error_);
    started_ns_.reset();
}

/* The count that is read after the last trigger has no edges beside it. */
void LineTriggers::rest_lens()
{
    parts_.lens->stop();
    hear_lens(rhythm_.get());
    if (started_ns_)
        take_count(read_count(), nullptr);
}

void LineTriggers::hear()
{
    throw_if(std::exchange(error_, nullptr));
    hear_edges();
    hear_lens(rhythm_.get());
    throw_if(lens_thread_.take_error());
}

/* Edges that came before the start are of triggers that are not ours, or that came to rest. */
void LineTriggers::hear_edges()
{
    for (int i = 0; parts_.sync && i < most_edges; i++) {
        const auto edge = parts_.sync->read();
        if (!edge)
            return;
        const auto time_ns = static_cast<std::int64_t>(edge->time_ns);
        const bool ours = started_ns_ && time_ns >= *started_ns_;
        if (ours && rhythm_->edge(time_ns) && parts_.lens)
            lens_thread_.ask(reading_time(time_ns));
    }
}

/* The count is read in the middle of plane 0's period, where no trigger falls: of the sweep that begins with
 * this edge, or, if the edge was heard too late for that, of the next one. */
std::int64_t LineTriggers::reading_time(std::int64_t edge_ns) const
{
    const std::int64_t wanted_ns = edge_ns + timing_.period_ns / 2;
    const std::int64_t late_ns = host_now_ns() - wanted_ns - timing_.tolerance_ns();
    const std::int64_t sweeps = late_ns > 0 ? late_ns / timing_.sweep_ns + 1 : 0;
    return wanted_ns + sweeps * timing_.sweep_ns;
}

void LineTriggers::hear_lens(const TriggerTimes *triggers)
{
    for (const LensNews &news : lens_thread_.take())
        take_count(news, triggers);
}

/* In the lens's thread, which alone uses the lens while it runs. */
void LineTriggers::watch_lens(const std::stop_token &stop)
{
    std::int64_t next_check_ns = host_now_ns() + check_period_ns;
    while (true) {
        lens_thread_.wait_until_asked(std::chrono::nanoseconds(check_period_ns), stop);
        if (stop.stop_requested())
            return;
        lens_thread_.tell(read_count());
        const std::int64_t now_ns = host_now_ns();
        if (now_ns < next_check_ns)
            continue;
        next_check_ns = now_ns + check_period_ns;
        parts_.lens->check();
    }
}

LineTriggers::LensNews LineTriggers::read_count() const
{
    try {
        const std::int64_t before_ns = host_now_ns();
        const std::uint32_t count = parts_.lens->frame_count();
        return {CountReading{count, before_ns, host_now_ns()}, {}};
    } catch (const LensError &error) {
        return {std::nullopt, error.what()};
    }
}

std::optional<CountReading> LineTriggers::take(const LensNews &news)
{
    if (!news.reading && !std::exchange(complained_, true))
        complaint_ = "The sequencer's count of triggers cannot be read: " + news.unreadable +
                     ". The sync line alone tells planes until it can. Check the wires and the speed of the "
                     "I2C bus.";
    return news.reading;
}

void LineTriggers::take_count(const LensNews &news, const TriggerTimes *triggers)
{
    if (const auto reading = take(news))
        count_->read(*reading, triggers);
    else
        count_->withdraw();
}

std::optional<std::uint64_t> LineTriggers::given() const
{
    return count_ ? std::optional(count_->given()) : std::nullopt;
}

SoftwareTriggers::SoftwareTriggers(const SweepTiming &timing, FrameNumbers numbers, CameraControl &camera,
                                   SteppedLens *lens, std::function<void()> on_news)
    : SoftwareTriggers(timing, numbers, camera, lens, std::make_unique<SentTriggers>(timing),
                       std::move(on_news))
{
}

SoftwareTriggers::SoftwareTriggers(const SweepTiming &timing, FrameNumbers numbers, CameraControl &camera,
                                   SteppedLens *lens, std::unique_ptr<SentTriggers> sent,
                                   std::function<void()> on_news)
    : Triggers(std::make_unique<TriggerLabeller>(timing, numbers, *sent)), timing_(timing), camera_(camera),
      lens_(lens), sent_(std::move(sent)), sender_(std::move(on_news))
{
}

void SoftwareTriggers::start()
{
    labeller_->start(PlaneLabeller::Beginning::FromRest, host_now_ns());
    if (lens_)
        lens_->start();
    next_sweep_++; /* the one before may have been broken off */
    sender_.start([this](const std::stop_token &stop) { send(stop); });
}

void SoftwareTriggers::stop() noexcept
{
    sender_.stop();
    sender_.take(); /* of no frame any more */
    if (lens_)
        attempt([this] { lens_->stop(); }, error_);
}

void SoftwareTriggers::hear()
{
    throw_if(std::exchange(error_, nullptr));
    for (const Trigger &trigger : sender_.take())
        sent_->sent(trigger);
    throw_if(sender_.take_error());
}

bool SoftwareTriggers::settle(unsigned plane, const std::stop_token &stop)
{
    if (!lens_)
        return true;
    lens_->move_to(plane);
    return lens_->wait_settled(stop);
}

/* In the sending thread, which alone uses the lens while it runs. */
void SoftwareTriggers::send(const std::stop_token &stop)
{
    std::int64_t due_ns = host_now_ns();
    for (;; next_sweep_++) {
        for (unsigned plane = 0; plane < timing_.planes; plane++) {
            if (!settle(plane, stop) || !sender_.sleep_until(due_ns, stop))
                return;
            const std::int64_t now_ns = host_now_ns();
            sender_.tell({next_sweep_ * timing_.planes + plane, now_ns});
            camera_.execute("TriggerSoftware");
            due_ns = std::max(due_ns, now_ns) + timing_.period_ns;
            if (lens_ && !sender_.sleep_until(host_now_ns() + timing_.exposure_ns, stop))
                return;
        }
    }
}

} // namespace dff
