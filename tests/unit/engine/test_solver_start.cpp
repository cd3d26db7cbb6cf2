/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Which of its two starts the CPU's solver takes, against the twin. */
#include "engine/cpu/depth_slice.h"
#include "engine/gaussian_blur.h"
#include "twin_bilateral_grid.h"
#include "twin_focus.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace dff;

namespace {

constexpr unsigned width = 150, height = 101, planes = 6;

/* A picture with waves in it and every third pixel's plane, on a slope. */
struct Known {
    Known(float wave, float slope)
    {
        for (unsigned y = 0; y < height; y++)
            for (unsigned x = 0; x < width; x++) {
                luma.push_back(
                    static_cast<uint8_t>(128.0f + 70.0f * std::sin(wave * x) + 40.0f * std::sin(0.07f * y)));
                const float plane = 0.5f * (planes - 1) * (1.0f + 0.9f * std::sin(slope * x + 0.02f * y));
                sparse.push_back((x + 2 * y) % 3 ? SparseDepth::unknown_plane
                                                 : static_cast<uint8_t>(2 * std::lround(plane)));
            }
    }

    std::vector<uint8_t> luma, sparse;
};

BilateralGrid::Parameters with_iterations(unsigned iterations)
{
    return {16, 16, 0, 0.1f, iterations};
}

struct Case {
    const char *name;
    Known last, now;
    bool goes_on;
};

void PrintTo(const Case &c, std::ostream *out)
{
    *out << c.name;
}

class SolverStart : public testing::TestWithParam<Case> {};

cl::Buffer uploaded(CommandQueue &queue, const std::vector<uint8_t> &bytes)
{
    cl::Buffer buffer = queue.allocate(bytes.size());
    queue.commands().enqueueWriteBuffer(buffer, CL_TRUE, 0, bytes.size(), bytes.data());
    return buffer;
}

/* Depth of a picture after some iterations, when the last one's solution is that of many. */
Volume depth_found(const Known &last, const Known &now, unsigned iterations)
{
    CommandQueue queue(Device::open(""));
    LumaGrid before(queue, width, height, with_iterations(300));
    before.run(uploaded(queue, last.sparse), uploaded(queue, last.luma));
    LumaGrid grid(queue, width, height, with_iterations(iterations));
    queue.commands().enqueueCopyBuffer(before.solution(), grid.solution(), 0, 0,
                                       before.solution().getInfo<CL_MEM_SIZE>());

    const StackShape shape{PixelFormat::Gray8, width, height, planes};
    DepthSlice slice(queue, shape, grid);
    const DepthCoder coder(queue, shape);
    const cl::Buffer depth = queue.allocate(width * height * sizeof(uint16_t)),
                     luma = uploaded(queue, now.luma);
    grid.run(uploaded(queue, now.sparse), luma);
    slice.run(grid, luma, coder, depth);
    Volume found(width, height, 1);
    const auto codes = read_back<uint16_t>(queue, depth, width * height);
    for (size_t i = 0; i < codes.size(); i++)
        found.values[i] = (codes[i] - 1) / 65534.0f * (planes - 1);
    return found;
}

} // namespace

TEST_P(SolverStart, agrees_with_its_twin)
{
    const auto &[name, last, now, goes_on] = GetParam();
    const Volume solution =
        twin::bilateral_solve(last.sparse, last.luma, {}, {}, width, height, with_iterations(300));
    for (const unsigned iterations : {0u, 3u}) {
        const twin::Continued continued = twin::solve_from_better_start(
            now.sparse, now.luma, solution, last.luma, with_iterations(iterations));
        ASSERT_TRUE(goes_on ? continued.residual_ratio < 0.5 : continued.residual_ratio > 2.0);
        const Volume expected = twin::gaussian_blur(continued.u, GaussianBlur::taps_for(16));
        const Volume found = depth_found(last, now, iterations);
        for (size_t i = 0; i < found.values.size(); i++)
            ASSERT_NEAR(found.values[i], expected.values[i], 0.03f) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(
    CpuKernels, SolverStart,
    testing::Values(Case{"the_same_picture", {0.05f, 0.03f}, {0.05f, 0.03f}, true},
                    Case{"a_little_lighter_at_the_right", {0.05f, 0.03f}, {0.051f, 0.03f}, true},
                    Case{"another_depth", {0.05f, 0.03f}, {0.05f, 0.06f}, false}),
    [](const auto &info) { return info.param.name; });
