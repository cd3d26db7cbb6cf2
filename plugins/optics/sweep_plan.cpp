/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/sweep_plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

namespace dff {

SweepPlan::SweepPlan(std::vector<double> powers) : powers_(std::move(powers))
{
    if (powers_.size() < min_planes || powers_.size() > max_planes)
        throw std::invalid_argument("a sweep has 2 to 64 planes, not " + std::to_string(powers_.size()));
    const bool finite =
        std::all_of(powers_.begin(), powers_.end(), [](double p) { return std::isfinite(p); });
    const auto rise = std::adjacent_find(powers_.begin(), powers_.end(), std::less_equal<>());
    if (!finite || rise != powers_.end())
        throw std::invalid_argument(
            "the planes' powers must be finite and fall from the nearest plane to the "
            "farthest (near is greater than far, in dioptres)");
}

SweepPlan SweepPlan::even(unsigned planes, double near, double far)
{
    std::vector<double> powers(planes);
    for (unsigned z = 0; z < planes; z++)
        powers[z] = planes > 1 ? near + (far - near) * z / (planes - 1) : near;
    return SweepPlan(std::move(powers));
}

SweepPlan SweepPlan::at(std::span<const double> powers)
{
    return SweepPlan({powers.begin(), powers.end()});
}

double SweepPlan::power_at(double z) const
{
    const double clamped = std::clamp(z, 0.0, static_cast<double>(planes() - 1));
    const auto k = std::min(static_cast<unsigned>(clamped), planes() - 2);
    return std::lerp(powers_[k], powers_[k + 1], clamped - k);
}

double SweepPlan::position_of(double power) const
{
    if (power >= near())
        return 0.0;
    if (power <= far())
        return planes() - 1;
    const auto above = std::lower_bound(powers_.begin(), powers_.end(), power, std::greater<>());
    const auto k = static_cast<unsigned>(above - powers_.begin()) - 1;
    return k + (powers_[k] - power) / (powers_[k] - powers_[k + 1]);
}

} // namespace dff
