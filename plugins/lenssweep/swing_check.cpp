/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "swing_check.h"

#include "sure_ratio.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace {

constexpr size_t quick_checks = 24; /* until then pairs follow each other quickly */
constexpr uint64_t quick_pairs = 3; /* from check to check */
constexpr uint64_t usual_pairs = 50;
constexpr double least_lag = 0.1; /* frames' times: what is less wrong than that is right */

/* How far beside the plane a curve through it and its neighbours has its top, in planes: of a Gaussian one,
 * whose logarithm is a parabola. Nothing if there is none. */
std::optional<double> peak(const std::vector<SwingCheck::Sharpness> &planes, unsigned plane, size_t block)
{
    const double before = planes[plane - 1][block];
    const double here = planes[plane][block];
    const double after = planes[plane + 1][block];
    if (!(before > 0 && here > 0 && after > 0))
        return std::nullopt;
    const double bend = std::log(before) - 2 * std::log(here) + std::log(after);
    if (!(bend < 0))
        return std::nullopt;
    return std::clamp((std::log(before) - std::log(after)) / (2 * bend), -1.0, 1.0);
}

} // namespace

bool SwingCheck::wants(const PlaneLabel &label) const
{
    return label.sweep / 2 >= next_;
}

void SwingCheck::add(const PlaneLabel &label, Sharpness sharpness)
{
    if (label.sweep / 2 > next_ || there_.empty()) {
        next_ = label.sweep / 2;
        there_.assign(planes_, {});
        back_.assign(planes_, {});
    }
    (label.sweep % 2 == 0 ? there_ : back_).at(label.plane) = std::move(sharpness);
    if (label.sweep % 2 == 1 && label.plane == 0)
        conclude();
}

/* After the last frame of a pair of sweeps. */
void SwingCheck::conclude()
{
    const size_t blocks = there_.front().size();
    const auto fits = [blocks](const Sharpness &plane) { return blocks > 0 && plane.size() == blocks; };
    if (std::all_of(there_.begin(), there_.end(), fits) && std::all_of(back_.begin(), back_.end(), fits)) {
        double change = 0;
        double way = 0;
        for (size_t block = 0; block < blocks; block++)
            compare(block, change, way);
        changes_.push_back(change);
        ways_.push_back(way);
    }
    there_.clear();
    next_ += changes_.size() < quick_checks ? quick_pairs : usual_pairs;
}

/* Where the block is sharpest on the way there and on the way back, as far as it stands out. */
void SwingCheck::compare(size_t block, double &change, double &way) const
{
    unsigned sharpest = 0;
    const auto both = [&](unsigned plane) { return there_[plane][block] + back_[plane][block]; };
    for (unsigned plane = 1; plane < planes_; plane++)
        sharpest = both(plane) > both(sharpest) ? plane : sharpest;
    if (sharpest == 0 || sharpest + 1 == planes_)
        return;
    const auto there = peak(there_, sharpest, block);
    const auto back = peak(back_, sharpest, block);
    if (!there || !back)
        return;
    const double height = both(sharpest) - (both(sharpest - 1) + both(sharpest + 1)) / 2;
    change += height * (*there - *back);
    way += height * 2;
}

std::optional<double> SwingCheck::lag() const
{
    const auto lag = sure_ratio(changes_, ways_);
    return lag && std::abs(*lag) > least_lag ? lag : std::nullopt;
}
