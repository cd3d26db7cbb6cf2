/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/cpu/luma_planes.h"

namespace dff {

/* What one pass over a stack's luma tells, on the CPU: the reference R = mean_z I (6) of Oliva-García 2022
 * and the pixels whose entropy along z (3) says that they moved. */
class StackStatistics {
public:
    StackStatistics(CommandQueue &queue, const StackShape &shape, float entropy_bits);

    void run(const LumaPlanes &luma);

    const cl::Buffer &mean() const { return mean_; }   /* uchar[height][width] */
    const cl::Buffer &moved() const { return moved_; } /* uchar[height][width]: 255 = moved */

private:
    CommandQueue &queue_;
    StackShape shape_;
    float entropy_bits_;
    cl::Kernel kernel_;
    cl::Buffer mean_, moved_;
};

} // namespace dff
