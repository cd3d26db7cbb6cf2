/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "step_tagger.h"

#include <algorithm>
#include <chrono>

namespace {

/* std::chrono's steady clock is CLOCK_MONOTONIC on Linux. */
uint64_t now_ns()
{
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

} // namespace

StepTagger::StepTagger(std::unique_ptr<dff::SteppedLens> lens, unsigned planes, unsigned settle_frames)
    : lens_(std::move(lens)), planes_(planes), settle_frames_(settle_frames)
{
    if (!lens_->knows_rest())
        check_.emplace(planes);
}

void StepTagger::restart()
{
    if (next_.plane > 0)
        next_ = {next_.sweep + 1, 0};
    positioned_ = false;
    held_ = 0;
    if (check_)
        check_.emplace(planes_);
}

/* Begins to rest at the next plane, unless interrupted. */
void StepTagger::position(const std::stop_token &stop)
{
    lens_->move_to(next_.plane);
    positioned_ = lens_->wait_settled(stop);
    rests_since_ns_ = now_ns();
    rested_frames_ = 0;
    has_plane_since_ns_.reset();
}

/* Whether the camera had told its lens the plane when it took the frame, as far as it says so. */
bool StepTagger::has_plane(std::optional<uint64_t> time_ns)
{
    const auto now = static_cast<int64_t>(now_ns());
    const int64_t age = time_ns ? now - static_cast<int64_t>(*time_ns) : 0;
    least_age_ns_ = std::min(least_age_ns_.value_or(age), age);
    if (has_plane_since_ns_)
        return !time_ns || age <= now - *has_plane_since_ns_;
    const auto said = lens_->at_plane();
    if (!said)
        return true;
    if (!*said)
        return false;
    has_plane_since_ns_ = now - *least_age_ns_ - static_cast<int64_t>(period_ns_ / 2);
    return !time_ns || age <= now - *has_plane_since_ns_;
}

/* Whether the frame is of a plane that is held after its label. */
bool StepTagger::is_held(const std::function<Sharpness()> &sharpness)
{
    if (held_ == 0)
        return false;
    const unsigned k = SettleCheck::held_frames + 1 - held_;
    check_->add_held(k, k + 1 >= SettleCheck::held_frames && sharpness ? sharpness() : Sharpness{});
    return true;
}

std::optional<PlaneLabel> StepTagger::label(std::optional<uint64_t> time_ns, const std::stop_token &stop,
                                            const std::function<Sharpness()> &sharpness)
{
    if (is_held(sharpness)) {
        if (--held_ == 0)
            position(stop);
        return std::nullopt;
    }
    const bool early = !positioned_ && !time_ns; /* it was there before the lens is moved */
    if (!positioned_)
        position(stop);
    const bool moved = early || (time_ns && *time_ns < rests_since_ns_ + period_ns_);
    if (!positioned_ || moved || !has_plane(time_ns) || ++rested_frames_ <= settle_frames_)
        return std::nullopt;
    const PlaneLabel label = next_;
    next_ =
        label.plane + 1 < planes_ ? PlaneLabel{label.sweep, label.plane + 1} : PlaneLabel{label.sweep + 1, 0};
    if (check_ && check_->add_labelled(check_->needs_next() && sharpness ? sharpness() : Sharpness{}))
        held_ = SettleCheck::held_frames;
    else
        position(stop);
    return label;
}
