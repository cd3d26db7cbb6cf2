/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sweep_capture.h"

#include "camera_control.h"
#include "lenssweep/lens/open_lens.h"

#include <algorithm>
#include <cmath>
#include <thread>

namespace dff {

namespace {

constexpr unsigned most_failures = 5;

/* Parts that do not go together. */
const CaptureSettings &checked(const CaptureSettings &settings)
{
    const LensKind lens = LensUri::parse(settings.lens).kind;
    if (lens == LensKind::Fpga && settings.trigger != TriggerKind::Line)
        throw std::invalid_argument("the lens " + settings.lens +
                                    " triggers the camera itself and needs trigger=line");
    if (lens != LensKind::Fpga && lens != LensKind::None && settings.trigger != TriggerKind::Software)
        throw std::invalid_argument("the lens " + settings.lens +
                                    " is moved step by step and needs trigger=software");
    const bool lines = !settings.run_line.empty() || !settings.sync_line.empty();
    if (lines && settings.trigger != TriggerKind::Line)
        throw std::invalid_argument("run-line and sync-line go with trigger=line only");
    return settings;
}

std::unique_ptr<Lens> open(const CaptureSettings &settings, AravisCamera &camera)
{
    return open_lens(LensUri::parse(settings.lens), {settings.lens_profile, &camera});
}

} // namespace

SweepCapture::SweepCapture(const CaptureSettings &settings, CaptureLog log)
    : log_(std::move(log)), settings_(checked(settings)), camera_(settings.camera, [this] { poll_.wake(); }),
      lens_(open(settings, camera_)),
      run_(settings.run_line.empty() ? nullptr : open_output_line(settings.run_line)),
      sync_(settings.sync_line.empty() ? nullptr : open_edge_line(settings.sync_line))
{
    set_exposure(camera_, settings_.exposure_us);
    if (settings_.gain)
        set_gain(camera_, *settings_.gain);
    if (!settings_.features.empty())
        camera_.set_features(settings_.features);
    set_timing();
}

SweepCapture::~SweepCapture()
{
    stop();
}

/* Whole microseconds, which is what sequencers count in. */
void SweepCapture::set_timing()
{
    const auto period_us = static_cast<std::int64_t>(std::floor(1e6 / settings_.frame_rate()));
    timing_.planes = settings_.plan.planes();
    timing_.period_ns = period_us * 1000;
    timing_.sweep_ns = timing_.planes * timing_.period_ns;
    timing_.exposure_ns = std::llround(settings_.exposure_us * 1000);
}

void SweepCapture::make_triggers()
{
    if (triggers_) {
        before_ = counts();
        unlabelled_ = 0; /* in before_ now */
        sweep_base_ = next_sweep_;
    }
    const FrameNumbers numbers(camera_.numbering());
    const auto woken = [this] { poll_.wake(); };
    if (settings_.trigger == TriggerKind::FreeRun)
        triggers_ = std::make_unique<FreeRun>(timing_, numbers);
    else if (settings_.trigger == TriggerKind::Software)
        triggers_ = std::make_unique<SoftwareTriggers>(timing_, numbers, camera_,
                                                       dynamic_cast<SteppedLens *>(lens_.get()), woken);
    else
        triggers_ = std::make_unique<LineTriggers>(
            timing_, numbers,
            LineTriggers::Parts{dynamic_cast<SequencedLens *>(lens_.get()), run_.get(), sync_.get()}, woken);
}

void SweepCapture::start(const PixelLayout &layout, int width, int height)
{
    stop();
    CameraRegion region = camera_.region();
    if (region.width != width || region.height != height)
        region = {0, 0, width, height};
    camera_.set_pixel_format(layout.genicam);
    camera_.set_region(region);
    set_up_trigger(camera_, {settings_.trigger, settings_.trigger_source, settings_.frame_rate()});
    prepare_lens();

    const double link_bits = camera_.told_link_bits();
    timing_.transfer_ns =
        link_bits > 0 ? std::llround(static_cast<double>(camera_.payload()) * 8e9 / link_bits) : 0;
    make_triggers();
    acquire();
    begin_triggers();
}

void SweepCapture::prepare_lens()
{
    lens_->prepare({settings_.plan, std::chrono::microseconds(timing_.period_ns / 1000),
                    std::chrono::microseconds(timing_.exposure_ns / 1000), run_ != nullptr});
}

void SweepCapture::acquire()
{
    buffers_ = std::max(16U, static_cast<unsigned>(std::lround(settings_.frame_rate() / 4)));
    stream_ = std::make_unique<CameraStream>(camera_, buffers_, camera_.payload(), [this] { poll_.wake(); });
    camera_.start_acquisition();
    wait_armed();
}

void SweepCapture::end_acquisition() noexcept
{
    if (!stream_)
        return;
    camera_.stop_acquisition();
    underruns_ += stream_->underruns();
    stream_.reset();
}

/* On a machine or a link that lags, frames of the triggers before may still be on their way; they would be
 * taken for the first ones of those that begin. They end with the stream. */
void SweepCapture::begin_anew()
{
    end_acquisition();
    acquire();
    begin_triggers();
}

/* A camera that does not say so is taken to be armed when it has started. */
void SweepCapture::wait_armed()
{
    if (settings_.trigger == TriggerKind::FreeRun)
        return;
    for (int i = 0; i < 100 && !trigger_armed(camera_); i++)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

void SweepCapture::begin_triggers()
{
    quiet_until_ns_.reset();
    last_frame_ns_ = host_now_ns();
    triggers_->start();
    log_.event("triggers begin");
}

/* They begin again when the frames that are under way are surely here. */
void SweepCapture::rest_triggers()
{
    triggers_->stop();
    quiet_until_ns_ = host_now_ns() + 2 * timing_.sweep_ns;
}

void SweepCapture::stop() noexcept
{
    if (triggers_)
        triggers_->stop();
    end_acquisition();
}

void SweepCapture::change(const CaptureSettings &settings)
{
    const bool timing_changed =
        settings.rate != settings_.rate || settings.exposure_us != settings_.exposure_us;
    if (settings.exposure_us != settings_.exposure_us)
        set_exposure(camera_, settings.exposure_us);
    if (settings.gain && settings.gain != settings_.gain)
        set_gain(camera_, *settings.gain);
    if (settings.rate != settings_.rate && settings_.trigger == TriggerKind::FreeRun)
        set_frame_rate(camera_, settings.frame_rate());
    settings_.rate = settings.rate;
    settings_.exposure_us = settings.exposure_us;
    settings_.gain = settings.gain;
    if (!timing_changed)
        return;
    set_timing();
    if (!stream_)
        return;
    rest_triggers();
    prepare_lens();
    make_triggers();
}

/* The planes cannot be told any more. */
void SweepCapture::recover()
{
    failures_++;
    labels_ = 0;
    const bool counted = settings_.trigger == TriggerKind::Line && !sync_;
    if (counted && !triggers_->restartable())
        throw CameraError(
            "The triggers rested, or the camera missed one, and nothing tells which plane comes "
            "next. Start again; to go on by itself this element needs sync-line or run-line.");
    if (failures_ > most_failures && settings_.trigger != TriggerKind::FreeRun)
        throw CameraError(
            "The camera's frames and the triggers do not fit together. Check that planes and rate are "
            "those of the sequencer, that sync-line pulses at plane 0, and that the camera takes every "
            "trigger (exposure, TriggerOverlap) and sends a frame within a period of its exposure "
            "and the time that the link needs for it. One that heeds no trigger, as most "
            "simulated cameras, needs trigger=free-run.");
    restarts_++;
    log_.event("planes cannot be told any more: the triggers begin anew");
    if (triggers_->restartable())
        rest_triggers();
    else
        triggers_->start();
}

FrameVerdict SweepCapture::judge(const CameraBuffer &buffer, const CameraFrame &frame)
{
    if (buffer.complete())
        return triggers_->label(frame);
    incomplete_++;
    return {std::nullopt, Unlabelled::Incomplete};
}

std::optional<CapturedPlane> SweepCapture::labelled(CameraBuffer buffer)
{
    last_frame_ns_ = host_now_ns();
    if (quiet_until_ns_) {
        unlabelled_++;
        return std::nullopt;
    }
    const CameraFrame frame = buffer.facts();
    const FrameVerdict verdict = judge(buffer, frame);
    log_.judged(frame, verdict);
    watch_.judged(verdict, triggers_->counts().dropped_sweeps);
    if (triggers_->lost())
        recover();
    if (!verdict.label)
        return std::nullopt;
    if (++labels_ >= timing_.planes)
        failures_ = 0;
    const std::int64_t exposed_ns = clock_.exposed_ns(frame, timing_.exposure_ns);
    const std::uint64_t sweep = sweep_base_ + verdict.label->sweep;
    next_sweep_ = std::max(next_sweep_, sweep + 1);
    return CapturedPlane{std::move(buffer), frame, sweep, verdict.label->plane,
                         verdict.label->trigger_ns.value_or(exposed_ns)};
}

/* A camera that is gone takes with it what is in its hands, as a lens. */
void SweepCapture::hear_triggers()
{
    try {
        triggers_->hear();
    } catch (const std::exception &) {
        if (camera_.gone())
            throw CameraError(camera_gone);
        throw;
    }
}

/* A frame is taken before the triggers are heard, so that its own is known. */
std::optional<CapturedPlane> SweepCapture::next(std::int64_t deadline_ns)
{
    while (true) {
        if (camera_.gone())
            throw CameraError(camera_gone);
        auto buffer = stream_->take();
        hear_triggers();
        if (buffer)
            return labelled(std::move(*buffer));
        const std::int64_t now_ns = host_now_ns();
        if (quiet_until_ns_ && now_ns >= *quiet_until_ns_)
            begin_anew();
        if (interrupted_.exchange(false) || now_ns >= deadline_ns)
            return std::nullopt;
        poll_.wait(triggers_->descriptor(), std::min(deadline_ns, quiet_until_ns_.value_or(deadline_ns)));
    }
}

void SweepCapture::interrupt() noexcept
{
    interrupted_ = true;
    poll_.wake();
}

std::string SweepCapture::take_complaint()
{
    std::string complaint = triggers_ ? triggers_->take_complaint() : std::string();
    return complaint.empty() ? watch_.take_complaint() : complaint;
}

CaptureCounts SweepCapture::counts() const
{
    CaptureCounts counts = before_;
    const LabelCounts labels = triggers_ ? triggers_->counts() : LabelCounts{};
    counts.labels.labelled += labels.labelled;
    counts.labels.unlabelled += labels.unlabelled;
    counts.labels.lost += labels.lost;
    counts.labels.doubled += labels.doubled;
    counts.labels.disagreements += labels.disagreements;
    counts.labels.dropped_sweeps += labels.dropped_sweeps;
    counts.wrong_edges += triggers_ ? triggers_->wrong_edges() : 0;
    counts.triggers += triggers_ ? triggers_->given().value_or(0) : 0;
    counts.wrong_counts += triggers_ ? triggers_->wrong_counts() : 0;
    counts.incomplete = incomplete_;
    counts.labels.unlabelled += unlabelled_;
    counts.underruns = underruns_ + (stream_ ? stream_->underruns() : 0);
    counts.restarts = restarts_;
    return counts;
}

LinkLoad SweepCapture::load()
{
    return {settings_.frame_rate(),       camera_.payload(),   settings_.exposure_us,
            1e6 / settings_.frame_rate(), camera_.link_bits(), camera_.packet()};
}

} // namespace dff
