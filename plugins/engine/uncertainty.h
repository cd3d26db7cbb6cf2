/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/depth_coder.h"
#include "engine/depth_fill.h"

namespace dff {

/* How far the depth may be off, one standard deviation: see kernels/uncertainty.cl. */
class Uncertainty {
public:
    Uncertainty(CommandQueue &queue, const StackShape &shape, const LowShape &low);

    /* The low picture `u` as the matching decided it, and as it is before the fill. */
    void remember_matched(const cl::Buffer &u);
    void remember_decided(const cl::Buffer &u);

    /* `filtered`: costs, low pictures short [z]; `depth`: the map of the final `u`. */
    void run(const cl::Buffer &u, const DepthFill &fill, const cl::Buffer &filtered,
             const NoiseEstimate &noise, DepthCoder &coder, const cl::Buffer &depth);

    const cl::Buffer &deviation() const { return deviation_; } /* low picture, planes */
    /* ushort[height][width], steps of the depth map; 0 where that is 0. */
    const cl::Buffer &map() const { return map_; }

private:
    CommandQueue &queue_;
    StackShape shape_;
    LowShape low_;
    cl::Kernel low_deviation_, upsample_deviation_;
    cl::Buffer matched_, decided_, deviation_, map_;
};

} // namespace dff
