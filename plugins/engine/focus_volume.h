/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/low_shape.h"
#include "engine/noise_estimate.h"

namespace dff {

/* The fine focus volume at low resolution: see kernels/focus_volume.cl. */
class FocusVolume {
public:
    FocusVolume(CommandQueue &queue, const StackShape &shape, const LowShape &low);

    /* Of device memory, beside the volume. */
    static uint64_t scratch_bytes(const StackShape &shape, const LowShape &low);

    /* Computes the planes that have changed, all if the noise has. */
    void run(const StackBuffer &stack, const NoiseEstimate &noise);

    const cl::Buffer &volume() const { return volume_; } /* low pictures short [z] */

private:
    CommandQueue &queue_;
    StackShape shape_;
    LowShape low_;
    cl::Kernel silent_, prepared_;
    cl::Buffer scratch_, volume_;
};

} // namespace dff
