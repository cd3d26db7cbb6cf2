/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "optics/sweep_plan.h"
#include "sensor.h"

#include <cstdint>
#include <mutex>

namespace dff {

/* Where the lens stands: the sequencer moves it, or the client does, through the camera's registers. */
class SimulatedLens {
public:
    LensPosition position() const;

    /* The sequencer's. */
    void jump(const LensPosition &position);

    /* Focuses on the plane that is nearest to `power` dioptres; a new sweep begins where the plane is not
     * after the one before. */
    void focus(const SweepPlan &plan, double power);

private:
    mutable std::mutex mutex_;
    LensPosition position_;
};

} // namespace dff
