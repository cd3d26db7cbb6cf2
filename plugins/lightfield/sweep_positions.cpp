/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sweep_positions.h"

#include "optics/dioptre.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dff {

namespace {

double position(const DepthFacts &facts, uint16_t pixel)
{
    const double even = (pixel - 1.0) / (DepthScale::max_pixel - 1);
    const DepthScale &scale = facts.scale;
    if (scale.unit == DepthUnit::Millimetre)
        return *sweep_position(facts,
                               dioptre_from_millimetre(scale.scale == 0.0 ? pixel : scale.value(pixel)));
    if (scale.unit == DepthUnit::Dioptre && scale.scale != 0.0)
        return sweep_position(facts, scale.value(pixel)).value_or(even);
    return even;
}

} // namespace

bool DepthFacts::operator==(const DepthFacts &other) const
{
    return scale.unit == other.scale.unit && scale.scale == other.scale.scale &&
           scale.offset == other.scale.offset && near == other.near && far == other.far;
}

std::vector<float> sweep_positions(const DepthFacts &facts)
{
    DepthFacts known = facts;
    if (!facts.knows_range() && facts.scale.unit == DepthUnit::Millimetre)
        known.near = dioptre_from_millimetre(500.0), known.far = 0.0;

    std::vector<float> positions(DepthScale::max_pixel + 1, std::numeric_limits<float>::quiet_NaN());
    for (size_t pixel = 1; pixel < positions.size(); pixel++)
        positions[pixel] =
            static_cast<float>(std::clamp(position(known, static_cast<uint16_t>(pixel)), 0.0, 1.0));
    return positions;
}

std::optional<double> sweep_position(const DepthFacts &facts, double dioptre)
{
    if (!facts.knows_range())
        return std::nullopt;
    return (facts.near - dioptre) / (facts.near - facts.far);
}

} // namespace dff
