/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "optics/sweep_plan.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace dff {

/* How near a plane lies: 1 for plane 0, 0 for the last one, in proportion to the plan's powers between them.
 * For lenses whose positions are in no unit. */
inline double relative_nearness(const SweepPlan &plan, unsigned plane)
{
    return (plan.power(plane) - plan.far()) / (plan.near() - plan.far());
}

/* Throws std::invalid_argument if the lens would not move between two planes. */
inline void require_different(const std::vector<double> &positions)
{
    if (std::adjacent_find(positions.begin(), positions.end()) != positions.end()) {
        throw std::invalid_argument("two planes fall on one position of the lens: ask for fewer planes");
    }
}

} // namespace dff
