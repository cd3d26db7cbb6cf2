/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sweep_tagger.h"

#include "lens/open_lens.h"

#include <cmath>
#include <stdexcept>

namespace {

/* Sweeps without a label after which mode=sync says what is wrong. */
constexpr unsigned patience_sweeps = 16;

} // namespace

SweepTagger::SweepTagger(const TagSettings &settings) : settings_(settings), plan_(settings.sweep.plan())
{
    auto lens = dff::open_lens(dff::LensUri::parse(settings.lens), {settings.lens_profile});
    if (settings.mode == GST_LENS_SWEEP_TAG_MODE_STEP) {
        open_step(std::move(lens));
    } else if (settings.mode == GST_LENS_SWEEP_TAG_MODE_SYNC) {
        open_sync(std::move(lens));
    } else {
        if (dynamic_cast<dff::SteppedLens *>(lens.get()) || dynamic_cast<dff::SequencedLens *>(lens.get()))
            throw std::invalid_argument("mode=cycle moves no lens; use mode=step with lens=" + settings.lens +
                                        ", or mode=sync with lens=fpga:");
        cycle_.emplace(plan_.planes(), std::nullopt);
    }
}

void SweepTagger::open_step(std::unique_ptr<dff::Lens> lens)
{
    if (!dynamic_cast<dff::SteppedLens *>(lens.get()))
        throw std::invalid_argument("mode=step needs a lens that can be moved, as lens=v4l2:/dev/video0 or "
                                    "lens=max14574:/dev/i2c-1");
    lens->prepare({plan_});
    lens->start();
    std::unique_ptr<dff::SteppedLens> stepped(dynamic_cast<dff::SteppedLens *>(lens.release()));
    step_ = std::make_unique<StepTagger>(std::move(stepped), plan_.planes(), settings_.settle_frames);
}

void SweepTagger::open_sync(std::unique_ptr<dff::Lens> lens)
{
    if (dynamic_cast<dff::SteppedLens *>(lens.get()) || settings_.sync_line.empty())
        throw std::invalid_argument("mode=sync needs sync-line, as gpiochip0:5, and lens=fpga: or none");
    auto line = dff::open_edge_line(settings_.sync_line);
    std::unique_ptr<dff::SequencedLens> sequencer;
    if (dynamic_cast<dff::SequencedLens *>(lens.get()))
        sequencer.reset(dynamic_cast<dff::SequencedLens *>(lens.release()));
    sync_ = std::make_unique<SyncTagger>(std::move(line), std::move(sequencer), plan_);
}

void SweepTagger::set_period(std::optional<uint64_t> period_ns)
{
    if (cycle_)
        cycle_->set_period(period_ns);
    else if (step_)
        step_->set_period(period_ns);
    else
        sync_->begin(std::chrono::microseconds{period_ns.value_or(0) / 1000});
}

void SweepTagger::restart()
{
    if (cycle_)
        cycle_->restart();
    if (step_)
        step_->restart();
}

std::optional<PlaneLabel> SweepTagger::label(const FrameTrace &trace, std::optional<uint64_t> time_ns,
                                             const std::stop_token &stop)
{
    if (cycle_)
        return cycle_->label(trace);
    if (step_)
        return step_->label(time_ns, stop);
    if (time_ns)
        *time_ns -= settings_.timestamp_delay_ns;
    const auto label = sync_->label(time_ns);
    unlabelled_ = label ? 0 : unlabelled_ + 1;
    return label;
}

std::string SweepTagger::warning() const
{
    if (cycle_ && cycle_->lost_place())
        return "Frames are missing and nothing says how many; the planes may be labelled wrongly from here "
               "on. Use "
               "a source that numbers its frames or gives them times.";
    return unlabelled_ == patience_sweeps * plan_.planes() ? sync_warning() : "";
}

std::string SweepTagger::sync_warning() const
{
    if (sync_->edges() == 0)
        return "No edges come on the sync line " + settings_.sync_line +
               ", so frames cannot be labelled: see whether the lens sweeps, and the line is the right one.";
    const std::string planes = std::to_string(plan_.planes());
    const auto misfit_ns = sync_->misfit_ns();
    if (misfit_ns)
        return "Frames and the edges of the sync line do not fit together: frames lie " +
               std::to_string(*misfit_ns / 1000) +
               " us off. Set timestamp-delay to the time from exposure to timestamp, and see whether there "
               "are " +
               planes + " planes.";
    return "Frames and the edges of the sync line do not fit together: see whether there are " + planes +
           " planes, and the camera sends each of them.";
}

double SweepTagger::power(unsigned plane) const
{
    return step_ && !step_->calibrated() ? NAN : plan_.power(plane);
}

int SweepTagger::code(unsigned plane) const
{
    if (step_)
        return step_->code(plane);
    return sync_ ? sync_->code(plane) : -1;
}
