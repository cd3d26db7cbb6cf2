/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "stage_positions.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

namespace {

bool rises_or_falls(const std::vector<gdouble> &values)
{
    return std::adjacent_find(values.begin(), values.end(), std::less_equal<>()) == values.end() ||
           std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
}

} // namespace

SweepProperties StagePositions::counted(SweepProperties sweep) const
{
    if (positions_um.empty())
        return sweep;
    if (positions_um.size() < dff::SweepPlan::min_planes || positions_um.size() > dff::SweepPlan::max_planes)
        throw std::invalid_argument("positions has " + std::to_string(positions_um.size()) +
                                    " values; a sweep has 2 to 64 planes");
    if (step_um != 0.0)
        throw std::invalid_argument(
            "positions and step-um are both set; one of them says where the planes are");
    if (!rises_or_falls(positions_um))
        throw std::invalid_argument(
            "positions must all rise or all fall, from the nearest plane to the farthest");
    if (!sweep.powers.empty() && sweep.powers.size() != positions_um.size())
        throw std::invalid_argument("positions has " + std::to_string(positions_um.size()) +
                                    " planes and powers " + std::to_string(sweep.powers.size()));
    sweep.planes = static_cast<guint>(positions_um.size());
    return sweep;
}

double StagePositions::of(unsigned plane) const
{
    if (!positions_um.empty())
        return positions_um.at(plane);
    return step_um == 0.0 ? NAN : step_um * plane;
}
