/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/distance_table.h"

#include "optics/dioptre.h"

#include <cmath>
#include <limits>

namespace dff {

namespace {

double distance_of(DepthUnit unit, double value)
{
    switch (unit) {
    case DepthUnit::Dioptre:
        return millimetre_from_dioptre(value) / 1e3;
    case DepthUnit::Millimetre:
        return value / 1e3;
    case DepthUnit::Micrometre:
        return value / 1e6;
    case DepthUnit::Index:
        break;
    }
    return value;
}

/* By how much distance_of() changes with `value`, per unit. */
double slope_of(DepthUnit unit, double value)
{
    if (unit != DepthUnit::Dioptre)
        return distance_of(unit, 1.0);
    const double distance = distance_of(unit, value);
    return distance * distance; /* of 1 / value */
}

} // namespace

std::vector<float> distance_table(const DepthScale &scale)
{
    std::vector<float> distances(DepthScale::max_pixel + 1, std::numeric_limits<float>::quiet_NaN());
    for (unsigned pixel = 1; pixel <= DepthScale::max_pixel; pixel++)
        distances[pixel] =
            static_cast<float>(distance_of(scale.unit, scale.value(static_cast<uint16_t>(pixel))));
    return distances;
}

std::vector<float> distance_slope_table(const DepthScale &scale)
{
    std::vector<float> slopes(DepthScale::max_pixel + 1, std::numeric_limits<float>::quiet_NaN());
    for (unsigned pixel = 1; pixel <= DepthScale::max_pixel; pixel++)
        slopes[pixel] = static_cast<float>(std::abs(scale.scale) *
                                           slope_of(scale.unit, scale.value(static_cast<uint16_t>(pixel))));
    return slopes;
}

} // namespace dff
