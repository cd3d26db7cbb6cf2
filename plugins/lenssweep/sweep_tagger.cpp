/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sweep_tagger.h"

#include "calibrated_powers.h"

#include "lens/found_lenses.h"

#include <cmath>
#include <stdexcept>

namespace {

/* Sweeps without a label after which step and sync say what is wrong. */
constexpr unsigned patience_sweeps = 16;

/* Where nothing is said a lens that knows its powers sweeps as it does in lenssweepsrc. */
dff::SweepPlan plan_of(const SweepProperties &sweep)
{
    return sweep.has_powers() ? sweep.plan() : SweepProperties{.planes = sweep.planes, .powers = {}}.plan();
}

} // namespace

SweepTagger::SweepTagger(const TagSettings &settings, const FindProperty &find_property)
    : settings_(settings), plan_(plan_of(settings.stage.counted(settings.sweep))),
      calibrated_powers_(calibrated_powers(settings.calibration, plan_.planes()))
{
    auto lens =
        dff::open_lens(dff::LensUri::parse(settings.lens), {settings.lens_profile, nullptr, find_property,
                                                            settings.mode == GST_LENS_SWEEP_TAG_MODE_SYNC});
    if (settings.mode == GST_LENS_SWEEP_TAG_MODE_STEP) {
        open_step(std::move(lens));
    } else if (settings.mode == GST_LENS_SWEEP_TAG_MODE_SYNC) {
        open_sync(std::move(lens));
    } else {
        if (dynamic_cast<dff::SteppedLens *>(lens.get()) || dynamic_cast<dff::SweptLens *>(lens.get()))
            throw std::invalid_argument("mode=cycle moves no lens; use mode=step with lens=" + settings.lens +
                                        ", or mode=sync with lens=fpga: or optotune:");
        cycle_.emplace(plan_.planes(), std::nullopt);
    }
}

void SweepTagger::open_step(std::unique_ptr<dff::Lens> lens)
{
    if (!dynamic_cast<dff::SteppedLens *>(lens.get()))
        throw std::invalid_argument("mode=step needs a lens that can be moved, as lens=v4l2:/dev/video0, "
                                    "lens=element:cam.lens-position or lens=max14574:/dev/i2c-1. " +
                                    dff::describe(dff::find_lenses(dff::this_machine())));
    lens->prepare({plan_});
    lens->start();
    std::unique_ptr<dff::SteppedLens> stepped(dynamic_cast<dff::SteppedLens *>(lens.release()));
    step_ = std::make_unique<StepTagger>(std::move(stepped), plan_.planes(), settings_.settle_frames);
}

void SweepTagger::open_sync(std::unique_ptr<dff::Lens> lens)
{
    if (dynamic_cast<dff::SteppedLens *>(lens.get()) || settings_.sync_line.empty())
        throw std::invalid_argument(
            "mode=sync needs sync-line, as gpiochip0:5, and lens=fpga:, optotune: or none");
    auto line = dff::open_edge_line(settings_.sync_line);
    std::unique_ptr<dff::SweptLens> swept;
    if (dynamic_cast<dff::SweptLens *>(lens.get()))
        swept.reset(dynamic_cast<dff::SweptLens *>(lens.release()));
    lens_sweeps_ = swept != nullptr;
    sync_ = std::make_unique<SyncTagger>(std::move(line), std::move(swept), plan_);
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
                                             const std::stop_token &stop,
                                             const std::function<StepTagger::Sharpness()> &sharpness)
{
    if (cycle_)
        return cycle_->label(trace);
    if (time_ns && sync_)
        *time_ns -= settings_.timestamp_delay_ns;
    const auto label = step_ ? step_->label(time_ns, stop, sharpness) : sync_->label(time_ns, sharpness);
    unlabelled_ = label || stop.stop_requested() ? 0 : unlabelled_ + 1;
    untimed_ = time_ns ? 0 : untimed_ + 1;
    return label;
}

std::string SweepTagger::warning()
{
    if (cycle_ && cycle_->lost_place())
        return tell_once(
            Cause::LostPlace,
            "Frames are missing and nothing says how many; the planes may be labelled wrongly from "
            "here on. Use a source that numbers its frames or gives them times.");
    if (step_ && step_->lag())
        return tell_once(Cause::StillMoves, step_warning());
    if (sync_ && sync_->lag())
        return tell_once(Cause::LateLens, swing_warning(*sync_->lag()));
    if (unlabelled_ < patience_sweeps * plan_.planes() + settings_.settle_frames)
        return "";
    if (step_)
        return tell_once(
            Cause::NeverRests,
            "None of the last " + std::to_string(unlabelled_) +
                " frames was taken with the lens at rest, by their times: see whether the source "
                "stamps its frames by the pipeline's clock and delivers them in time, and "
                "settle-frames.");
    if (untimed_ >= unlabelled_)
        return tell_once(Cause::Untimed,
                         "The frames have no times on the pipeline's clock, so the edges of the sync "
                         "line cannot be matched to them: use a source that stamps its frames.");
    return tell_once(sync_->edges() == 0 ? Cause::NoEdges : Cause::Misfit, sync_warning());
}

std::string SweepTagger::tell_once(Cause cause, const std::string &text)
{
    const unsigned bit = 1U << static_cast<unsigned>(cause);
    if (told_ & bit)
        return "";
    told_ |= bit;
    return text;
}

std::string SweepTagger::step_warning() const
{
    return "Frames are labelled before the lens has come to rest: held at a plane, their sharpness goes on "
           "to "
           "change by " +
           std::to_string(std::lround(100 * step_->lag().value_or(0))) +
           " % of what a plane changes. Set settle-frames to more than " +
           std::to_string(settings_.settle_frames) + ".";
}

std::string SweepTagger::swing_warning(std::chrono::microseconds lag) const
{
    const std::chrono::nanoseconds told{settings_.timestamp_delay_ns};
    const auto right = std::max(told + lag, std::chrono::nanoseconds{0});
    return "What is sharp in a plane on the lens's way there is sharp in another on its way back: it stands "
           "about " +
           std::to_string(std::abs(lag.count())) + " us " + (lag.count() > 0 ? "behind" : "before") +
           " where frames are labelled. Let the camera be triggered that much " +
           (lag.count() > 0 ? "later" : "earlier") + " and set timestamp-delay to " +
           std::to_string(right.count()) + ".";
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
    if (!calibrated_powers_.empty())
        return calibrated_powers_.at(plane);
    const bool lens_knows = step_ ? step_->calibrated() : lens_sweeps_;
    const bool known = lens_knows || (settings_.sweep.has_powers() && !step_);
    return known ? plan_.power(plane) : NAN;
}

int SweepTagger::code(unsigned plane) const
{
    if (step_)
        return step_->code(plane);
    return sync_ ? sync_->code(plane) : -1;
}
