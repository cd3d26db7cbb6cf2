/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/luma.h"

namespace dff {

/* The focus measure P_z (2) of Oliva-García 2022 and what is kept of it for each pixel. */
class FocusMeasure {
public:
    /* `levels` pictures of falling resolution are multiplied, 1 to 4; the paper has 3. */
    FocusMeasure(CommandQueue &queue, const StackShape &shape, unsigned levels);

    void run(const Luma &luma);

    const cl::Buffer &peak() const { return peak_; }   /* float[height][width]: max_z P */
    const cl::Buffer &place() const { return place_; } /* uchar[height][width]: where it is, in half planes */
    const cl::Buffer &mean() const { return mean_; }   /* float[height][width]: mean_z P */

private:
    CommandQueue &queue_;
    StackShape shape_;
    unsigned levels_;
    cl::Kernel downsample_, coarse_gradient_, focus_product_;
    cl::Buffer coarse_, gradient_, peak_, place_, mean_;
};

} // namespace dff
