/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/low_shape.h"
#include "engine/noise_estimate.h"

namespace dff {

/* Takes from coarse focus what edges that are sharp in other planes explain: see kernels/focus_leak.cl. */
class FocusLeak {
public:
    FocusLeak(CommandQueue &queue, const LowShape &low);

    static constexpr float least_step = 2.0f; /* pixels a plane */

    /* Whether planes lie so far apart that edges leave a rim. */
    static bool is_needed(float blur_step) { return blur_step > least_step; }

    /* Changes the low pictures short `focus`[z] in place. medians: of its greatest over z and of its range,
     * DN. */
    void run(const cl::Buffer &focus, const cl::Buffer &medians, const NoiseEstimate &noise, float blur_step);

private:
    CommandQueue &queue_;
    LowShape low_;
    cl::Kernel begin_, spread_, gather_, take_;
    cl::Buffer reached_[2], leak_;
};

} // namespace dff
