/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "simulated_lens.h"

#include <cmath>

namespace dff {

LensPosition SimulatedLens::position() const
{
    const std::scoped_lock lock(mutex_);
    return position_;
}

void SimulatedLens::jump(const LensPosition &position)
{
    const std::scoped_lock lock(mutex_);
    position_ = position;
}

void SimulatedLens::focus(const SweepPlan &plan, double power)
{
    const auto plane = static_cast<unsigned>(std::lround(plan.position_of(power)));
    const std::scoped_lock lock(mutex_);
    if (plane <= position_.plane)
        position_.sweep++;
    position_.plane = plane;
}

} // namespace dff
