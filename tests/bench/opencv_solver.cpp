/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "opencv_solver.h"

#include "engine/bilateral_grid.h"

#include <opencv2/imgproc.hpp>
#include <opencv2/ximgproc/edge_filter.hpp>

namespace dff::bench {

namespace {

/* (6) of Oliva-García 2022; planes of a packed I420 stack are whole pictures one after the other. */
cv::Mat mean_picture(const BenchStack &stack)
{
    const int width = static_cast<int>(stack.shape.width),
              rows = static_cast<int>(stack.shape.height) * 3 / 2;
    cv::Mat sum = cv::Mat::zeros(rows, width, CV_32F), mean, colours;
    for (uint32_t z = 0; z < stack.shape.planes; z++)
        cv::accumulate(cv::Mat(rows, width, CV_8U,
                               const_cast<std::byte *>(stack.memory.data()) + stack.layout[z].offset),
                       sum); /* only read */
    sum.convertTo(mean, CV_8U, 1.0 / stack.shape.planes);
    cv::cvtColor(mean, colours, cv::COLOR_YUV2BGR_I420);
    return colours;
}

} // namespace

OpencvSolver::OpencvSolver(const BenchStack &stack, std::span<const uint16_t> sparse)
    : guide_(mean_picture(stack))
{
    const cv::Mat codes(guide_.size(), CV_16U, const_cast<uint16_t *>(sparse.data())); /* only read */
    codes.convertTo(planes_, CV_8U, 1.0 / 257);
    cv::Mat(codes != 0).convertTo(confidence_, CV_32F, 1.0 / 255);
}

void OpencvSolver::run()
{
    cv::ximgproc::fastBilateralSolverFilter(guide_, planes_, confidence_, filled_);
}

void OpencvSolver::run_with_our_cells()
{
    constexpr BilateralGrid::Parameters ours;
    static_assert(ours.sigma_chroma == 0);
    constexpr double one_cell = 256.0;
    cv::ximgproc::fastBilateralSolverFilter(guide_, planes_, confidence_, filled_, ours.sigma_xy,
                                            ours.sigma_luma, one_cell);
}

} // namespace dff::bench
