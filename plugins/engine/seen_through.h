/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/cost_volume.h"
#include "engine/depth_parameters.h"

namespace dff {

/* Which of two things a cell is of where the farther one is seen through the nearer: see
 * kernels/seen_through.cl. */
class SeenThrough {
public:
    SeenThrough(CommandQueue &queue, const LowShape &low);

    /* Changes the costs in place. */
    void run(const CostVolume &cost, const NoiseEstimate &noise, Prefer prefer);

private:
    CommandQueue &queue_;
    LowShape low_;
    cl::Kernel prefer_;
};

} // namespace dff
