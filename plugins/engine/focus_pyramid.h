/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/noise_estimate.h"
#include "engine/small_planes.h"

namespace dff {

/* Focus on coarser scales: see kernels/focus_pyramid.cl. */
class FocusPyramid {
public:
    FocusPyramid(CommandQueue &queue, const LowShape &low);

    /* Of device memory, all of it. */
    static uint64_t memory(const LowShape &low);

    /* Computes the planes that have changed, all if the noise has. */
    void run(const SmallPlanes &small, const NoiseEstimate &noise, const StackBuffer &stack);

    struct Level {
        LowShape shape;         /* its scale: pixels of the stack a cell */
        cl::Buffer luma, focus; /* low pictures short [z] */
    };
    const std::vector<Level> &levels() const { return levels_; } /* the finest, which the volume has, first */

private:
    CommandQueue &queue_;
    cl::Kernel mean_colours_, halve_luma_, measure_focus_;
    std::vector<Level> levels_;
    cl::Buffer scratch_;
};

} // namespace dff
