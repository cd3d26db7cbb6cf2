/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/seen_through.h"

#include "engine/opencl/program.h"

namespace dff {

SeenThrough::SeenThrough(CommandQueue &queue, const LowShape &low)
    : queue_(queue), low_(low), prefer_(Program(queue.device(), "seen_through").kernel("prefer"))
{
}

void SeenThrough::run(const CostVolume &cost, const NoiseEstimate &noise, Prefer prefer)
{
    queue_.begin_stage("seen-through");
    queue_.run(prefer_, low_.rows(), cost.cost(), cost.top(), cost.median_top(), noise.noise(),
               cl_int{prefer == Prefer::Far}, low_.width, low_.stride, low_.planes);
}

} // namespace dff
