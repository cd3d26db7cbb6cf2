/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/depth_scale.h"

#include "optics/dioptre.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace dff {

namespace {

constexpr double steps = DepthScale::max_pixel - 1;

/* Linear interpolation in a table of one value a plane. */
double interpolate(const std::vector<double> &values, double z)
{
    const auto k = std::min(static_cast<size_t>(z), values.size() - 2);
    return std::lerp(values[k], values[k + 1], z - static_cast<double>(k));
}

double find(const std::vector<double> &values, double value)
{
    const bool rising = values.back() > values.front();
    for (size_t k = 0; k + 2 < values.size(); k++)
        if (rising ? value <= values[k + 1] : value >= values[k + 1])
            return static_cast<double>(k) + (value - values[k]) / (values[k + 1] - values[k]);
    const size_t k = values.size() - 2;
    return static_cast<double>(k) + (value - values[k]) / (values[k + 1] - values[k]);
}

} // namespace

DepthEncoder DepthEncoder::index(unsigned planes)
{
    const double step = (planes - 1) / steps;
    return {planes, {DepthUnit::Index, step, -step}};
}

DepthEncoder DepthEncoder::dioptre(const SweepPlan &plan)
{
    return dioptre(plan, plan.near(), plan.far());
}

DepthEncoder DepthEncoder::dioptre(const SweepPlan &plan, double near, double far)
{
    const double step = (far - near) / steps;
    DepthEncoder encoder(plan.planes(), {DepthUnit::Dioptre, step, near - step});
    encoder.plan_ = plan;
    return encoder;
}

DepthEncoder DepthEncoder::millimetre(const SweepPlan &plan)
{
    DepthEncoder encoder(plan.planes(), {DepthUnit::Millimetre, 1.0, 0.0});
    encoder.plan_ = plan;
    return encoder;
}

DepthEncoder DepthEncoder::micrometre(std::vector<double> positions_um)
{
    const bool falls = std::adjacent_find(positions_um.begin(), positions_um.end(), std::less_equal<>()) ==
                       positions_um.end();
    const bool rises = std::adjacent_find(positions_um.begin(), positions_um.end(), std::greater_equal<>()) ==
                       positions_um.end();
    if (positions_um.size() < SweepPlan::min_planes || !(falls || rises))
        throw std::invalid_argument("the planes' stage positions must all rise or all fall");
    const double step = (positions_um.back() - positions_um.front()) / steps;
    DepthEncoder encoder(static_cast<unsigned>(positions_um.size()),
                         {DepthUnit::Micrometre, step, positions_um.front() - step});
    encoder.positions_um_ = std::move(positions_um);
    return encoder;
}

double DepthEncoder::value_at(double z) const
{
    if (scale_.unit == DepthUnit::Dioptre)
        return plan_->power_at(z);
    if (scale_.unit == DepthUnit::Millimetre)
        return millimetre_from_dioptre(plan_->power_at(z));
    return scale_.unit == DepthUnit::Micrometre ? interpolate(positions_um_, z) : z;
}

double DepthEncoder::slope(double z) const
{
    constexpr double around = 0.25; /* planes */
    const double before = std::max(z - around, 0.0),
                 after = std::min(z + around, static_cast<double>(planes_ - 1));
    const double slope = std::abs((value_at(after) - value_at(before)) / scale_.scale) / (after - before);
    return slope < DepthScale::max_pixel ? slope
                                         : DepthScale::max_pixel; /* NaN, too, where both lie at infinity */
}

uint16_t DepthEncoder::encode(double z) const
{
    if (std::isnan(z))
        return DepthScale::no_value;
    z = std::clamp(z, 0.0, static_cast<double>(planes_ - 1));
    const double pixel = std::round((value_at(z) - scale_.offset) / scale_.scale);
    return static_cast<uint16_t>(std::clamp(pixel, 1.0, static_cast<double>(DepthScale::max_pixel)));
}

std::optional<double> DepthEncoder::decode(uint16_t pixel) const
{
    if (pixel == DepthScale::no_value)
        return std::nullopt;
    double z = scale_.value(pixel);
    if (scale_.unit == DepthUnit::Dioptre)
        z = plan_->position_of(scale_.value(pixel));
    else if (scale_.unit == DepthUnit::Millimetre)
        z = plan_->position_of(dioptre_from_millimetre(scale_.value(pixel)));
    else if (scale_.unit == DepthUnit::Micrometre)
        z = find(positions_um_, scale_.value(pixel));
    return std::clamp(z, 0.0, static_cast<double>(planes_ - 1));
}

} // namespace dff
