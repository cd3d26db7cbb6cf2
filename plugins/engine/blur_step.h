/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/focus_pyramid.h"
#include "engine/focus_volume.h"

namespace dff {

/* By how many pixels the circle of confusion grows from plane to plane: see kernels/blur_step.cl. */
class BlurStep {
public:
    BlurStep(CommandQueue &queue, const FocusPyramid &pyramid);

    struct Blur {
        float step = 0.0f; /* pixels of circle of confusion a plane; 0 before there is any */
        float t = 0.0f;    /* of the noise */
    };
    /* Waits for the device. `last`: of the stack before, whose step it keeps to where this one tells none. */
    Blur read(const FocusVolume &focus, const FocusPyramid &pyramid, const NoiseEstimate &noise,
              const Blur &last);

    /* How fast focus falls on a scale of so many pixels a cell; `softened`: by how much the blur against
     * noise makes a step seem smaller; rho is above 1 where too little has a peak. */
    struct Fall {
        float scale, rho, softened;
    };
    /* By the scale where a plane is about two cells of blur; 0 where none tells. */
    static float step_of(std::span<const Fall> falls);

    /* Of the last stack, the stack's own scale first. */
    const std::vector<Fall> &falls() const { return falls_; }

private:
    void measure(const cl::Buffer &focus, const LowShape &shape, size_t level);

    CommandQueue &queue_;
    cl::Kernel find_least_, find_peaks_, judge_peaks_, quantile_;
    cl::Buffer least_, strength_, ratio_, floor_;
    std::vector<cl::Buffer> rhos_;
    std::vector<Fall> falls_;
};

} // namespace dff
