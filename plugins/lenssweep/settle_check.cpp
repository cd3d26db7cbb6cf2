/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "settle_check.h"

#include "sure_ratio.h"

#include <utility>

namespace {

constexpr size_t quick_checks = 24;  /* until then checks follow each other quickly */
constexpr unsigned quick_sweeps = 2; /* from check to check */
constexpr unsigned usual_sweeps = 50;
constexpr double least_lag = 0.03; /* of a step: what is less wrong than that is right */

} // namespace

/* One plane further each time, so that every plane has its turn. */
void SettleCheck::set_next_check()
{
    check_at_ +=
        1 + static_cast<uint64_t>(planes_) * (changes_.size() < quick_checks ? quick_sweeps : usual_sweeps);
}

bool SettleCheck::add_labelled(Sharpness sharpness)
{
    const bool due = labelled_++ >= check_at_;
    if (!sharpness.empty())
        before_ = std::exchange(last_, std::move(sharpness));
    if (due && (last_.empty() || before_.size() != last_.size())) {
        set_next_check(); /* the pictures cannot be measured, or have just changed */
        return false;
    }
    return due;
}

void SettleCheck::add_held(unsigned k, Sharpness sharpness)
{
    if (k + 1 == held_frames) {
        held_ = std::move(sharpness);
        return;
    }
    if (k != held_frames)
        return;
    if (!sharpness.empty() && sharpness.size() == held_.size() && sharpness.size() == last_.size()) {
        double change = 0;
        double step = 0;
        for (size_t block = 0; block < sharpness.size(); block++) {
            const double way = held_[block] - before_[block];
            change += (sharpness[block] - last_[block]) * way;
            step += way * way;
        }
        changes_.push_back(change);
        steps_.push_back(step);
    }
    set_next_check();
}

std::optional<double> SettleCheck::lag() const
{
    const auto lag = sure_ratio(changes_, steps_);
    return lag && *lag > least_lag ? lag : std::nullopt;
}
