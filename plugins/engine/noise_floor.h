/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/focus_volume.h"
#include "engine/small_planes.h"

namespace dff {

/* Makes what noise leaves in focus the same in all planes: see kernels/noise_floor.cl. */
class NoiseFloor {
public:
    NoiseFloor(CommandQueue &queue, const LowShape &low);

    /* Low pictures short [z], which stay until the next run. */
    const cl::Buffer &run(const FocusVolume &focus, const SmallPlanes &small, const NoiseEstimate &noise);

    const cl::Buffer &curve() const { return curve_; } /* float: c0, c1, c2, the least and the greatest I */

private:
    CommandQueue &queue_;
    LowShape low_;
    cl::Kernel find_curve_, even_noise_;
    cl::Buffer curve_, evened_;
};

} // namespace dff
