/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/cpu/luma_planes.h"

namespace dff {

/* The planes of the pixels whose focus can be told, on the CPU: (2), (5) of Oliva-García 2022. */
class FocusTiles {
public:
    /* As FocusMeasure and SparseDepth take them. */
    FocusTiles(CommandQueue &queue, const StackShape &shape, unsigned levels, float tolerance);

    /* Leaves out the pixels that `moved` says (255), if given. */
    void run(const LumaPlanes &luma, const cl::Buffer *moved, bool with_confidence);

    const cl::Buffer &planes() const { return sparse_; }         /* uchar[height][width] or unknown_plane */
    const cl::Buffer &confidence() const { return confidence_; } /* uchar[height][width] */

private:
    CommandQueue &queue_;
    StackShape shape_;
    float tolerance_;
    size_t stride_;
    cl::NDRange tiles_;
    cl::Kernel focus_tiles_, select_ridges_;
    cl::Buffer peak_memory_, peak_, peak_plane_, tile_sums_, sparse_, confidence_;
};

} // namespace dff
