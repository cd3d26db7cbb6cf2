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

    void run(const StackBuffer &stack, const NoiseEstimate &noise);

    const cl::Buffer &volume() const { return volume_; } /* low pictures [z], DN */

private:
    CommandQueue &queue_;
    StackShape shape_;
    LowShape low_;
    cl::Kernel thirds_, blur_columns_, blur_rows_, focus_columns_, focus_columns_blurred_, focus_rows_;
    cl::Buffer samples_, sample_rows_, half_blurred_, blurred_, columns_, volume_;
};

} // namespace dff
