/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/stack_assembler.h"

#include <bit>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

using dff::FinishedSweep;
using dff::FrameVerdict;
using dff::StackAssembler;

namespace {

constexpr unsigned planes = 4;
constexpr uint64_t all = 0b1111;

std::vector<FinishedSweep> take(StackAssembler &assembler)
{
    std::vector<FinishedSweep> finished;
    while (const auto next = assembler.next_finished())
        finished.push_back(*next);
    return finished;
}

std::vector<FinishedSweep> feed(StackAssembler &assembler,
                                std::initializer_list<std::pair<uint64_t, unsigned>> frames)
{
    std::vector<FinishedSweep> finished;
    for (const auto &[sweep, plane] : frames) {
        assembler.add(sweep, plane);
        for (const FinishedSweep &next : take(assembler))
            finished.push_back(next);
    }
    return finished;
}

} // namespace

TEST(StackAssembler, whole_sweeps_end_with_their_last_frame)
{
    StackAssembler assembler(planes, 2);
    EXPECT_EQ(feed(assembler, {{7, 0}, {7, 1}, {7, 2}}), std::vector<FinishedSweep>{});
    EXPECT_EQ(feed(assembler, {{7, 3}}), (std::vector<FinishedSweep>{{7, all}}));
    EXPECT_EQ(feed(assembler, {{8, 0}, {8, 1}, {8, 2}, {8, 3}}), (std::vector<FinishedSweep>{{8, all}}));
}

TEST(StackAssembler, sweeps_may_run_backwards)
{
    StackAssembler assembler(planes, 2);
    EXPECT_EQ(feed(assembler, {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 3}, {1, 2}, {1, 1}, {1, 0}}),
              (std::vector<FinishedSweep>{{0, all}, {1, all}}));
    EXPECT_EQ(assembler.reordered(), 0u);
}

TEST(StackAssembler, two_frames_may_overtake_a_third_ends_the_sweep)
{
    StackAssembler assembler(planes, 2);
    EXPECT_EQ(feed(assembler, {{0, 0}, {0, 1}, {0, 3}, {1, 0}, {1, 1}, {0, 2}}),
              (std::vector<FinishedSweep>{{0, all}}));
    EXPECT_EQ(assembler.reordered(), 1u);

    StackAssembler losing(planes, 2);
    EXPECT_EQ(feed(losing, {{0, 0}, {0, 1}, {0, 3}, {1, 0}, {1, 1}, {1, 2}}),
              (std::vector<FinishedSweep>{{0, 0b1011}}));
    EXPECT_EQ(losing.add(0, 2), FrameVerdict::Late);
}

TEST(StackAssembler, sweeps_of_which_no_frame_came_end_too)
{
    StackAssembler assembler(planes, 0);
    EXPECT_EQ(feed(assembler, {{0, 0}, {3, 0}}), (std::vector<FinishedSweep>{{0, 0b0001}, {1, 0}, {2, 0}}));
}

TEST(StackAssembler, the_same_frame_twice_is_used_once)
{
    StackAssembler assembler(planes, 2);
    EXPECT_EQ(assembler.add(0, 1), FrameVerdict::Taken);
    EXPECT_EQ(assembler.add(0, 1), FrameVerdict::Repeated);
}

TEST(StackAssembler, a_source_that_numbers_anew_is_followed)
{
    StackAssembler assembler(planes, 2);
    feed(assembler, {{900, 0}, {900, 1}, {900, 2}, {900, 3}});
    std::vector<FinishedSweep> finished;
    for (uint64_t sweep = 0; sweep < 5; sweep++)
        for (const FinishedSweep &next : feed(assembler, {{sweep, 0}, {sweep, 1}, {sweep, 2}, {sweep, 3}}))
            finished.push_back(next);
    EXPECT_EQ(finished, (std::vector<FinishedSweep>{{3, 0b1000}, {4, all}}));
}

TEST(StackAssembler, a_leap_of_the_number_is_no_loss_of_a_million_sweeps)
{
    StackAssembler assembler(planes, 2);
    feed(assembler, {{0, 0}, {0, 1}});
    EXPECT_EQ(feed(assembler, {{~uint64_t{0}, 0}, {~uint64_t{0}, 1}, {~uint64_t{0}, 2}, {~uint64_t{0}, 3}}),
              (std::vector<FinishedSweep>{{0, 0b0011}, {~uint64_t{0}, all}}));
}

TEST(StackAssembler, impossible_stacks_are_refused)
{
    EXPECT_THROW(StackAssembler(1, 2), std::invalid_argument);
    EXPECT_THROW(StackAssembler(65, 2), std::invalid_argument);
    StackAssembler largest(64, 2);
    for (unsigned z = 0; z < 64; z++)
        largest.add(0, z);
    EXPECT_EQ(take(largest), (std::vector<FinishedSweep>{{0, ~uint64_t{0}}}));
}

/* Random losses, doubles and swaps: no plane may ever land in a wrong sweep, and the counts must add up. */
TEST(StackAssembler, no_disorder_puts_a_plane_into_a_wrong_sweep)
{
    for (unsigned seed = 0; seed < 300; seed++) {
        std::mt19937 random(seed);
        const unsigned n = 2 + random() % 63;
        const unsigned allowance = random() % 4;
        std::vector<std::pair<uint64_t, unsigned>> frames;
        for (uint64_t sweep = 0; sweep < 20; sweep++)
            for (unsigned z = 0; z < n; z++) {
                if (random() % 16 == 0)
                    continue;
                frames.emplace_back(sweep, z);
                if (random() % 16 == 0)
                    frames.emplace_back(sweep, z);
            }
        for (size_t i = 0; i + 8 < frames.size(); i++)
            if (random() % 8 == 0)
                std::swap(frames[i], frames[i + random() % 8]);

        StackAssembler assembler(n, allowance);
        std::map<uint64_t, uint64_t> taken;
        std::map<uint64_t, uint64_t> finished;
        unsigned verdicts[3] = {};
        const auto collect = [&] {
            for (const FinishedSweep &next : take(assembler)) {
                EXPECT_TRUE(finished.empty() || finished.rbegin()->first + 1 == next.sweep)
                    << "seed " << seed;
                EXPECT_TRUE(finished.emplace(next.sweep, next.present).second) << "seed " << seed;
            }
        };
        for (const auto &[sweep, plane] : frames) {
            const FrameVerdict verdict = assembler.add(sweep, plane);
            verdicts[static_cast<int>(verdict)]++;
            if (verdict == FrameVerdict::Taken) {
                EXPECT_FALSE(finished.contains(sweep)) << "seed " << seed;
                EXPECT_FALSE(taken[sweep] >> plane & 1) << "seed " << seed;
                taken[sweep] |= uint64_t{1} << plane;
            }
            collect();
        }
        assembler.finish();
        collect();

        EXPECT_EQ(verdicts[0] + verdicts[1] + verdicts[2], frames.size());
        unsigned present = 0;
        for (const auto &[sweep, bits] : finished) {
            EXPECT_EQ(bits, taken.contains(sweep) ? taken[sweep] : 0) << "seed " << seed;
            present += static_cast<unsigned>(std::popcount(bits));
        }
        EXPECT_EQ(present, verdicts[0]) << "seed " << seed;
    }
}
