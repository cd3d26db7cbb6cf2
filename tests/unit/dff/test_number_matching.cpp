/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "dff/number_matching.h"

#include <gtest/gtest.h>
#include <string>
#include <vector>

using namespace dff;

namespace {

/* Streams of numbers, the k-th taken at the time k; -1 was lost. Returns for each stack the index of its
 * depth map, or -1. */
std::vector<int> match(const std::vector<int> &stacks, const std::vector<int> &depths, bool timed)
{
    const auto at = [&](const std::vector<int> &numbers, size_t k) {
        return NumberedTime{static_cast<uint64_t>(numbers[k]),
                            timed ? std::optional<uint64_t>(k) : std::nullopt};
    };
    NumberMatching matching;
    std::vector<int> found;
    size_t d = 0;
    for (size_t k = 0; k < stacks.size(); k++) {
        if (stacks[k] < 0)
            continue;
        found.push_back(-1);
        for (bool looks = true; looks && d < depths.size();) {
            if (depths[d] < 0) {
                d++;
                continue;
            }
            const auto order = matching.order(at(depths, d), at(stacks, k));
            looks = order == NumberMatching::Order::Earlier;
            if (order == NumberMatching::Order::Later)
                break;
            if (order == NumberMatching::Order::Same)
                found.back() = static_cast<int>(d);
            matching.pass_depth(static_cast<uint64_t>(depths[d++]));
        }
        matching.pass_stack(static_cast<uint64_t>(stacks[k]));
    }
    return found;
}

} // namespace

class NumbersAnew : public testing::TestWithParam<bool> {};

INSTANTIATE_TEST_SUITE_P(Matching, NumbersAnew, testing::Bool(),
                         [](const auto &timed) { return std::string(timed.param ? "timed" : "untimed"); });

TEST_P(NumbersAnew, one_lost_costs_one)
{
    const std::vector<int> numbers{0, 1, 2, 3, 4, 0, 1, 2, 3, 4};
    for (int lost = 0; lost < 10; lost++) {
        std::vector<int> with_hole = numbers, expected{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
        with_hole[static_cast<size_t>(lost)] = -1;
        expected[static_cast<size_t>(lost)] = -1;
        EXPECT_EQ(match(numbers, with_hole, GetParam()), expected) << "depth " << lost;
        expected.erase(expected.begin() + lost);
        EXPECT_EQ(match(with_hole, numbers, GetParam()), expected) << "stack " << lost;
    }
}

TEST_P(NumbersAnew, the_last_of_one_and_the_first_of_the_next_may_be_lost)
{
    EXPECT_EQ(match({0, 1, 2, 3, 0, 1, 2, 3}, {0, 1, -1, -1, -1, 1, 2, 3}, GetParam()),
              (std::vector<int>{0, 1, -1, -1, -1, 5, 6, 7}));
    EXPECT_EQ(match({0, 1, -1, -1, -1, 1, 2, 3}, {0, 1, 2, 3, 0, 1, 2, 3}, GetParam()),
              (std::vector<int>{0, 1, 5, 6, 7}));
}

/* Three of the second numbering were lost: what comes next does not look like a new one, but by its time. */
TEST(Matching, goes_by_time_where_a_beginning_was_lost)
{
    EXPECT_EQ(match({0, 1, 2, 0, 1, 2, 3}, {0, 1, 2, -1, -1, -1, 3}, true),
              (std::vector<int>{0, 1, 2, -1, -1, -1, 6}));
}

TEST(Matching, is_never_lost_for_good)
{
    std::vector<int> stacks{7, 8, 9, -1, -1, -1}, depths{7, 8, 9, 0, 1, 2};
    for (int k = 10; k < 100; k++) {
        stacks.push_back(k);
        depths.push_back(k);
    }
    EXPECT_EQ(match(stacks, depths, false).back(), static_cast<int>(depths.size()) - 1);
}
