/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/focus_measure.h"
#include "twin_focus.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace dff;

namespace {

struct Case {
    PixelFormat format;
    unsigned width, height, planes, levels;
};

void PrintTo(const Case &c, std::ostream *out)
{
    *out << c.width << "x" << c.height << "x" << c.planes << " levels " << c.levels;
}

} // namespace

class FocusMeasureShapes : public testing::TestWithParam<Case> {};

TEST_P(FocusMeasureShapes, agrees_with_its_twin)
{
    const Case &c = GetParam();
    const TestStack stack({c.format, c.width, c.height, c.planes});
    CommandQueue queue(Device::open(""));
    StackBuffer buffer(queue, stack.shape);
    Luma luma(queue, stack.shape);
    FocusMeasure focus(queue, stack.shape, c.levels);
    buffer.assign(stack.view());
    luma.run(buffer);
    focus.run(luma);

    const twin::Focus expected = twin::focus_product(twin::luma(stack), c.levels);
    const size_t pixels = expected.place.size();
    const auto peak = read_back<float>(queue, focus.peak(), pixels);
    const auto mean = read_back<float>(queue, focus.mean(), pixels);
    const auto place = read_back<uint8_t>(queue, focus.place(), pixels);
    size_t other_places = 0;
    for (size_t i = 0; i < pixels; i++) {
        ASSERT_NEAR(peak[i], expected.peak.values[i], 1e-4f * expected.peak.values[i] + 1e-3f)
            << "pixel " << i;
        ASSERT_NEAR(mean[i], expected.mean.values[i], 1e-4f * expected.mean.values[i] + 1e-3f)
            << "pixel " << i;
        other_places += place[i] != expected.place[i];
    }
    EXPECT_LE(other_places, pixels / 1000) << "places may differ only where two are equal within rounding";
}

TEST(FocusMeasure, between_planes_that_are_equally_sharp_is_their_middle)
{
    for (const unsigned equal : {1u, 2u, 3u}) {
        const TestStack stack = stack_with_equal_planes(2, equal);
        CommandQueue queue(Device::open(""));
        StackBuffer buffer(queue, stack.shape);
        Luma luma(queue, stack.shape);
        FocusMeasure focus(queue, stack.shape, 3);
        buffer.assign(stack.view());
        luma.run(buffer);
        focus.run(luma);
        const size_t pixels = size_t{stack.shape.width} * stack.shape.height;
        const auto places = read_back<uint8_t>(queue, focus.place(), pixels);
        EXPECT_GT(std::ranges::count(places, 2 * 2 + equal - 1), pixels * 9 / 10);
    }
}

INSTANTIATE_TEST_SUITE_P(
    FocusMeasure, FocusMeasureShapes,
    testing::Values(Case{PixelFormat::Gray8, 64, 64, 2, 3}, Case{PixelFormat::Gray8, 97, 65, 10, 3},
                    Case{PixelFormat::Gray16, 80, 71, 6, 3}, Case{PixelFormat::Bgr, 129, 64, 6, 3},
                    Case{PixelFormat::Nv12, 66, 130, 4, 2}, Case{PixelFormat::I420, 100, 66, 6, 1},
                    Case{PixelFormat::Rgbx, 90, 90, 64, 4}, Case{PixelFormat::Rgba64, 81, 71, 6, 3}));
