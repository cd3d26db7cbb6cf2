/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/cpu/luma_planes.h"

namespace dff {

/* One pass over a stack's luma on the CPU: the planes of the pixels whose focus can be told, (2), (5) of
 * Oliva-García 2022, the reference R = mean_z I (6), and the pixels whose entropy along z (3) says that they
 * moved. */
class FocusTiles {
public:
    /* As FocusMeasure, SparseDepth and ZEntropy take them. */
    FocusTiles(CommandQueue &queue, const StackShape &shape, unsigned levels, float tolerance,
               float entropy_bits);

    /* Without those that moved, if `motion_mask`. */
    void run(const LumaPlanes &luma, bool motion_mask, bool with_confidence);

    const cl::Buffer &places() const
    {
        return sparse_;
    } /* uchar[height][width], half planes or unknown_plane */
    const cl::Buffer &confidence() const { return confidence_; } /* uchar[height][width] */
    const cl::Buffer &mean() const { return mean_; }             /* uchar[height][width] */
    const cl::Buffer &moved() const { return moved_; }           /* uchar[height][width]: 255 = moved */

private:
    CommandQueue &queue_;
    StackShape shape_;
    float tolerance_, entropy_bits_;
    size_t stride_;
    cl::NDRange tiles_;
    cl::Kernel focus_tiles_, select_ridges_;
    cl::Buffer peak_memory_, peak_, place_, tile_sums_, sparse_, confidence_, mean_, moved_;
};

} // namespace dff
