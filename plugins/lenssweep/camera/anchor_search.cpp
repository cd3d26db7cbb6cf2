/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "anchor_search.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace dff {

void AnchorSearch::start(PlaneLabeller::Beginning beginning)
{
    beginning_ = beginning;
    frames_.clear();
    before_.reset();
    failed_ = false;
}

void AnchorSearch::resume(const CameraAnchor &before, std::int64_t off_ns)
{
    start(PlaneLabeller::Beginning::UnderWay);
    before_ = before;
    off_ns_ = off_ns;
}

bool AnchorSearch::near_the_one_before(std::int64_t offset_ns) const
{
    return !before_ || std::abs(offset_ns - before_->offset_ns) <= off_ns_ + timing_.period_ns / 16;
}

std::size_t AnchorSearch::needed() const
{
    return beginning_ == PlaneLabeller::Beginning::FromRest ? timing_.planes
                                                            : 3 * std::size_t{timing_.planes};
}

std::size_t AnchorSearch::most() const
{
    return beginning_ == PlaneLabeller::Beginning::FromRest ? 8 * needed() : 2 * needed();
}

/* What follows if the first frame, by its number, is of this trigger; nothing if that cannot be. */
std::optional<CameraAnchor> AnchorSearch::fit(std::int64_t index, const TriggerTimes &triggers) const
{
    const std::uint64_t first_id = std::min_element(frames_.begin(), frames_.end(), [this](auto &a, auto &b) {
                                       return numbers_.steps(a.id, b.id) > 0;
                                   })->id;
    std::int64_t latency_ns = std::numeric_limits<std::int64_t>::max();
    std::int64_t least_ns = std::numeric_limits<std::int64_t>::max();
    std::int64_t most_ns = std::numeric_limits<std::int64_t>::min();
    for (const CameraFrame &frame : frames_) {
        const std::int64_t steps = numbers_.steps(first_id, frame.id);
        const std::int64_t trigger_ns = triggers.time_of(index + steps);
        latency_ns = std::min(latency_ns, frame.arrival_ns - trigger_ns);
        least_ns = std::min(least_ns, frame.camera_ns - trigger_ns);
        most_ns = std::max(most_ns, frame.camera_ns - trigger_ns);
    }
    const bool from_rest = beginning_ == PlaneLabeller::Beginning::FromRest;
    const std::int64_t margin_ns = from_rest ? -timing_.period_ns / 8 : timing_.period_ns / 32;
    const std::int64_t transfer_ns = latency_ns - timing_.exposure_ns - timing_.transfer_ns;
    if (transfer_ns < margin_ns || transfer_ns > timing_.period_ns - timing_.period_ns / (from_rest ? 8 : 32))
        return std::nullopt;
    const std::int64_t last_index = index + numbers_.steps(first_id, frames_.back().id);
    if (frames_.front().camera_ns == 0)
        return CameraAnchor{latency_ns, latency_ns, last_index};
    const std::int64_t offset_ns = least_ns + (most_ns - least_ns) / 2;
    if (most_ns - least_ns > timing_.tolerance_ns() || !near_the_one_before(offset_ns))
        return std::nullopt;
    return CameraAnchor{offset_ns, latency_ns, last_index};
}

std::optional<CameraAnchor> AnchorSearch::only_fit(const TriggerTimes &triggers) const
{
    const std::int64_t first = triggers.first()->index;
    if (beginning_ == PlaneLabeller::Beginning::FromRest)
        return fit(first, triggers);
    const std::int64_t reach = 4 * std::int64_t{timing_.planes};
    std::optional<CameraAnchor> found;
    for (std::int64_t index = first - reach; index <= first + reach; index++) {
        const auto anchor = fit(index, triggers);
        if (anchor && found)
            return std::nullopt;
        if (anchor)
            found = anchor;
    }
    return found;
}

void AnchorSearch::give_up()
{
    frames_.clear();
    failed_ = true;
}

std::optional<CameraAnchor> AnchorSearch::add(const CameraFrame &frame, const TriggerTimes &triggers)
{
    if (failed_ && beginning_ == PlaneLabeller::Beginning::FromRest)
        return std::nullopt;
    frames_.push_back(frame);
    if (frames_.size() < needed())
        return std::nullopt;
    const unsigned proofs = beginning_ == PlaneLabeller::Beginning::FromRest ? 2 : 3;
    const bool possible = triggers.first() && triggers.proofs() >= proofs;
    const auto anchor = possible ? only_fit(triggers) : std::nullopt;
    if (anchor)
        failed_ = false;
    else if (frames_.size() >= most() || (possible && beginning_ == PlaneLabeller::Beginning::UnderWay))
        give_up();
    return anchor;
}

} // namespace dff
