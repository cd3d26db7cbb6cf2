/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lenssweep/sync_cycle.h"

#include <gtest/gtest.h>
#include <random>
#include <string>

namespace {

constexpr uint64_t slot = 6'400'000; /* ns */
constexpr uint64_t origin = 1000 * slot;

std::string text(const std::optional<PlaneLabel> &label)
{
    return label ? std::to_string(label->plane) : "-";
}

/* Sweeps of `planes` slots with `sweeps` edges; frames of all of them but the first two, which teach the
 * period, labelled by a cycle that expects `expected` planes. */
std::string labels_of(unsigned planes, unsigned expected, int64_t delay_ns)
{
    SyncCycle cycle(expected);
    std::string labels;
    for (unsigned sweep = 0; sweep < 12; ++sweep) {
        cycle.add_edge(origin + sweep * planes * slot);
        for (unsigned plane = 0; plane < planes; ++plane) {
            const auto label = cycle.label(static_cast<uint64_t>(
                static_cast<int64_t>(origin + (sweep * planes + plane) * slot) + delay_ns));
            if (sweep > 9)
                labels += text(label);
        }
    }
    return labels;
}

} // namespace

TEST(SyncCycle, frames_are_labelled_from_edge_to_edge)
{
    EXPECT_EQ(labels_of(3, 3, 0), "012012");
}

TEST(SyncCycle, a_little_jitter_does_no_harm)
{
    EXPECT_EQ(labels_of(3, 3, static_cast<int64_t>(slot / 5)), "012012");
    EXPECT_EQ(labels_of(3, 3, -static_cast<int64_t>(slot / 5)), "012012");
}

TEST(SyncCycle, frames_between_two_places_are_not_labelled_and_the_misfit_is_told)
{
    EXPECT_EQ(labels_of(3, 3, static_cast<int64_t>(slot * 2 / 5)), "------");
    SyncCycle cycle(2);
    for (unsigned sweep = 0; sweep < 3; ++sweep)
        cycle.add_edge(origin + sweep * 2 * slot);
    EXPECT_EQ(cycle.misfit_ns(), std::nullopt);
    cycle.label(origin + 4 * slot + slot * 2 / 5);
    EXPECT_EQ(cycle.misfit_ns(), std::optional<int64_t>(slot * 2 / 5));
}

TEST(SyncCycle, another_number_of_planes_is_not_labelled_as_if_it_were_right)
{
    EXPECT_EQ(labels_of(4, 8, 0), "--------"); /* every second slot only */
    EXPECT_EQ(labels_of(3, 2, 0).find('1'), std::string::npos);
    EXPECT_EQ(labels_of(8, 4, 0).find_first_of("123"), std::string::npos);
}

TEST(SyncCycle, a_lens_that_goes_to_and_fro_has_two_sweeps_from_edge_to_edge)
{
    SyncCycle cycle(3, true);
    std::string planes;
    std::string sweeps;
    for (unsigned period = 0; period < 8; ++period) {
        cycle.add_edge(origin + period * 6 * slot);
        for (unsigned frame = 0; frame < 6; ++frame) {
            const auto label = cycle.label(origin + (period * 6 + frame) * slot);
            if (period < 6)
                continue;
            planes += text(label);
            sweeps += label ? std::to_string(label->sweep) + " " : "-";
        }
    }
    EXPECT_EQ(planes, "012210012210");
    EXPECT_EQ(sweeps, "12 12 12 13 13 13 14 14 14 15 15 15 ");
}

TEST(SyncCycle, before_the_period_is_known_nothing_is_labelled)
{
    SyncCycle cycle(2);
    EXPECT_EQ(cycle.label(origin), std::nullopt);
    cycle.add_edge(origin);
    EXPECT_EQ(cycle.label(origin), std::nullopt);
    cycle.add_edge(origin + 2 * slot);
    EXPECT_EQ(cycle.label(origin + 2 * slot), std::nullopt);
}

/* Frames and edges lost at random, with jitter: labels are missing, and none is wrong. */
TEST(SyncCycle, no_label_is_wrong_whatever_is_lost)
{
    std::mt19937 random(4); // NOLINT(bugprone-random-generator-seed): the same sequences each time
    uint64_t labelled = 0;
    uint64_t sent = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const unsigned planes = 2 + random() % 9;
        const unsigned lost_frames = random() % 30;
        const unsigned lost_edges = random() % 30;
        const int64_t jitter = static_cast<int64_t>(slot / 10);
        SyncCycle cycle(planes);
        for (unsigned sweep = 0; sweep < 60; ++sweep) {
            const auto begin = static_cast<int64_t>(origin + sweep * planes * slot);
            if (random() % 100 >= lost_edges)
                cycle.add_edge(static_cast<uint64_t>(begin + static_cast<int64_t>(random() % 1000)));
            for (unsigned plane = 0; plane < planes; ++plane) {
                const int64_t shake =
                    static_cast<int64_t>(random() % static_cast<unsigned>(2 * jitter)) - jitter;
                if (random() % 100 < lost_frames)
                    continue;
                ++sent;
                const auto label =
                    cycle.label(static_cast<uint64_t>(begin + static_cast<int64_t>(plane * slot) + shake));
                labelled += label.has_value();
                ASSERT_TRUE(!label || label->plane == plane) << "trial " << trial << " sweep " << sweep;
            }
        }
    }
    EXPECT_GT(labelled, sent / 2);
}
