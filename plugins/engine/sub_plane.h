/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/focus_pyramid.h"
#include "engine/focus_volume.h"

namespace dff {

/* Where between the planes a cell lies: see kernels/sub_plane.cl. */
class SubPlane {
public:
    SubPlane(CommandQueue &queue, const LowShape &low);

    /* Changes the low picture `u` in place. */
    void run(const cl::Buffer &u, const FocusVolume &focus, const FocusPyramid &pyramid,
             const NoiseEstimate &noise, float blur_step);

private:
    CommandQueue &queue_;
    LowShape low_;
    cl::Kernel find_least_, quantile_, refine_, even_out_;
    cl::Buffer least_, placed_, floor_;
};

} // namespace dff
