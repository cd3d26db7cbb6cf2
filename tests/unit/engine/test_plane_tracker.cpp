/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/plane_tracker.h"
#include "test_stack.h"

#include <gtest/gtest.h>

using namespace dff;

namespace {

constexpr StackShape shape{PixelFormat::Gray8, 64, 64, 4};
constexpr uint64_t all = 0b1111;

/* Planes of the sweeps given. */
StackView view_of(const TestStack &stack, const std::vector<uint64_t> &sweeps)
{
    StackView view = stack.view();
    for (uint32_t z = 0; z < sweeps.size(); z++)
        view.identities.push_back(PlaneIdentity{sweeps[z], z});
    return view;
}

} // namespace

TEST(PlaneTracker, the_first_stack_is_all_new)
{
    const TestStack stack(shape);
    EXPECT_EQ(PlaneTracker().changed(view_of(stack, {7, 7, 7, 7})), all);
}

TEST(PlaneTracker, a_rolling_window_has_one_new_plane)
{
    const TestStack stack(shape);
    PlaneTracker tracker;
    tracker.remember(view_of(stack, {7, 7, 7, 7}));
    EXPECT_EQ(tracker.changed(view_of(stack, {8, 7, 7, 7})), 0b0001u);
    tracker.remember(view_of(stack, {8, 7, 7, 7}));
    EXPECT_EQ(tracker.changed(view_of(stack, {8, 8, 7, 7})), 0b0010u);
}

TEST(PlaneTracker, after_a_gap_all_that_was_missed_is_new)
{
    const TestStack stack(shape);
    PlaneTracker tracker;
    tracker.remember(view_of(stack, {8, 7, 7, 7}));
    EXPECT_EQ(tracker.changed(view_of(stack, {8, 8, 8, 7})), 0b0110u);
}

TEST(PlaneTracker, planes_of_which_nothing_is_known_are_new)
{
    const TestStack stack(shape);
    StackView before = view_of(stack, {7, 7, 7, 7}), after = view_of(stack, {8, 7, 7, 7});
    before.identities[2].reset();
    after.identities[2].reset();
    PlaneTracker tracker;
    tracker.remember(before);
    EXPECT_EQ(tracker.changed(after), 0b0101u);
    tracker.remember(stack.view());
    EXPECT_EQ(tracker.changed(stack.view()), all);
}

TEST(PlaneTracker, a_plane_with_other_pixels_is_new)
{
    TestStack stack(shape);
    PlaneTracker tracker;
    tracker.remember(view_of(stack, {7, 7, 7, 7}));
    for (size_t i = 0; i < size_t{64} * 64; i++)
        stack.memory[stack.layout[1].offset + i] ^= std::byte{1};
    EXPECT_EQ(tracker.changed(view_of(stack, {8, 7, 7, 7})), 0b0011u);
}

TEST(PlaneTracker, stacks_whose_sweeps_are_not_numbered_are_all_new)
{
    const TestStack stack(shape);
    PlaneTracker tracker;
    tracker.remember(view_of(stack, {0, 0, 0, 0}));
    EXPECT_EQ(tracker.changed(view_of(stack, {0, 0, 0, 0})), all);
}

TEST(PlaneTracker, sweeps_that_are_numbered_anew_are_all_new)
{
    const TestStack stack(shape);
    PlaneTracker tracker;
    tracker.remember(view_of(stack, {1, 0, 0, 0}));
    EXPECT_EQ(tracker.changed(view_of(stack, {0, 0, 0, 0})), all);
}

TEST(PlaneTracker, a_plane_in_another_place_is_new)
{
    const TestStack stack(shape);
    PlaneTracker tracker;
    StackView view = view_of(stack, {7, 7, 7, 7});
    tracker.remember(view);
    std::swap(view.identities[0], view.identities[1]);
    EXPECT_EQ(tracker.changed(view), 0b0011u);
}

TEST(PlaneTracker, forgets)
{
    const TestStack stack(shape);
    PlaneTracker tracker;
    tracker.remember(view_of(stack, {7, 7, 7, 7}));
    tracker.forget();
    EXPECT_EQ(tracker.changed(view_of(stack, {7, 7, 7, 7})), all);
}
