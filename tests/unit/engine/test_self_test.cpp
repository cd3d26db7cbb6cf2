/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * What the self-test of drivers is held to, and that it sees what is wrong. */
#include "engine/gaussian_blur.h"
#include "engine/self_test.h"
#include "twin_bilateral_grid.h"
#include "twin_focus.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

using namespace dff;

namespace {

class SelfTest : public testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(SelfTest, SelfTest, testing::Values(Method::Volume, Method::Paper));

constexpr float last_plane = self_test::shape.planes - 1;

} // namespace

TEST_P(SelfTest, what_is_stored_is_where_the_stack_is_sharp)
{
    const auto stored = self_test::stored(GetParam());
    const auto places = self_test::places();
    ASSERT_EQ(stored.size(), places.size());
    for (size_t i = 0; i < places.size(); i++)
        ASSERT_NEAR(stored[i] / 255.0f * last_plane,
                    self_test::truth(self_test::shape, places[i].x, places[i].y), 0.5f)
            << places[i].x << "," << places[i].y;
}

TEST_P(SelfTest, this_device_makes_what_is_stored_in_both_styles)
{
    for (const KernelStyle style : {KernelStyle::Pixels, KernelStyle::Tiles})
        EXPECT_LE(self_test::difference(self_test::depth_on(device_with(style), GetParam()),
                                        self_test::stored(GetParam())),
                  0.5 * self_test::largest_difference)
            << "where depth is meant to have changed, run print_self_test; tiles "
            << (style == KernelStyle::Tiles);
}

TEST(SelfTest, what_is_stored_of_the_paper_is_the_twins)
{
    TestStack stack(self_test::shape);
    stack.memory = self_test::stack();
    const Volume luma = twin::luma(stack);
    const auto moved = twin::z_entropy(luma, 2.0f);
    const auto sparse = twin::sparse_depth(twin::focus_product(luma, 3), &moved, 1.4f);
    const Volume filled = twin::bilateral_solve(sparse, twin::mean_luma(luma), {}, {}, self_test::shape.width,
                                                self_test::shape.height, {});
    const Volume u = twin::gaussian_blur(filled, GaussianBlur::taps_for(16));
    const auto stored = self_test::stored(Method::Paper);
    const auto places = self_test::places();
    for (size_t i = 0; i < places.size(); i++)
        ASSERT_NEAR(stored[i], 255.0f * u.at(places[i].x, places[i].y) / last_plane, 1.5f);
}

/* A sixteenth of the rows, as of one row of the grid. */
TEST(SelfTest, a_strip_of_another_depth_is_wrong)
{
    const auto stored = self_test::stored(Method::Paper);
    std::vector<uint8_t> found(stored.begin(), stored.end());
    const auto places = self_test::places();
    for (size_t i = 0; i < places.size(); i++)
        if (places[i].y >= 128 && places[i].y < 144)
            found[i] = static_cast<uint8_t>(255 - found[i]);
    EXPECT_GT(self_test::difference(found, stored), self_test::largest_difference);
}
