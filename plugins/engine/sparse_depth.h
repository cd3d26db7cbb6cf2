/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/focus_measure.h"
#include "engine/z_entropy.h"

namespace dff {

/* The planes of the pixels whose focus can be told: (2), (5) of Oliva-García 2022. */
class SparseDepth {
public:
    static constexpr uint8_t unknown_plane = 255;

    /* Keeps pixels whose best response is `tolerance` times the mean over the planes. */
    SparseDepth(CommandQueue &queue, const StackShape &shape, float tolerance);

    /* Leaves out pixels that moved, where `motion` is given. */
    void run(const FocusMeasure &focus, const ZEntropy *motion);

    /* Writes the confidence uchar[height][width] of the focus measure. */
    void run_confidence(const FocusMeasure &focus);

    const cl::Buffer &places() const
    {
        return sparse_;
    } /* uchar[height][width], half planes or unknown_plane */
    const cl::Buffer &confidence() const { return confidence_; } /* uchar[height][width] */

private:
    CommandQueue &queue_;
    StackShape shape_;
    float tolerance_;
    cl::Kernel sum_rows_, mean_of_rows_, row_maximum_kernel_, select_ridges_, focus_confidence_;
    cl::Buffer row_sums_, total_mean_, row_maximum_, sparse_, confidence_;
};

} // namespace dff
