/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "bench_stack.h"

#include <opencv2/core.hpp>

namespace dff::bench {

/* OpenCV's fast bilateral solver on the problem that method=paper solves: the sparse depth
 * map of a stack, spread along the mean of its planes in colours. */
class OpencvSolver {
public:
    /* sparse: unit=index, 0 where nothing is known. */
    OpencvSolver(const BenchStack &stack, std::span<const uint16_t> sparse);

    /* With its defaults: cells of 8 pixels, 8 DN of luma and of chroma. */
    void run();

    /* With cells as large as those of method=paper. */
    void run_with_our_cells();

private:
    cv::Mat guide_, planes_, confidence_, filled_;
};

} // namespace dff::bench
