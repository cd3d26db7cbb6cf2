/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "settle_check.h"

#include <cmath>
#include <numeric>
#include <utility>

namespace {

constexpr size_t least_checks = 12;
constexpr size_t quick_checks = 24;  /* until then checks follow each other quickly */
constexpr unsigned quick_sweeps = 2; /* from check to check */
constexpr unsigned usual_sweeps = 50;
constexpr double least_lag = 0.03;       /* of a step: what is less wrong than that is right */
constexpr double least_significance = 4; /* standard errors above 0 */

double mean(const std::vector<double> &values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/* Of the mean of `changes`, if they are `lag` of the steps and what is left is chance. */
double standard_error(const std::vector<double> &changes, const std::vector<double> &steps, double lag)
{
    double squares = 0;
    for (size_t k = 0; k < changes.size(); k++) {
        const double chance = changes[k] - lag * steps[k];
        squares += chance * chance;
    }
    const auto count = static_cast<double>(changes.size());
    return std::sqrt(squares / (count - 1) / count);
}

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
    if (changes_.size() < least_checks)
        return std::nullopt;
    const double change = mean(changes_);
    const double lag = change / mean(steps_);
    const bool sure = change > least_significance * standard_error(changes_, steps_, lag);
    return sure && lag > least_lag ? std::optional(lag) : std::nullopt;
}
