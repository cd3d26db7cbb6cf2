/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "label_bench.h"

#include "lenssweep/camera/plane_labeller.h"
#include "lenssweep/camera/trigger_times.h"

#include <gtest/gtest.h>

using dff::FrameNumbering;
using dff::FrameNumbers;
using dff::PlaneLabeller;
using dff::Unlabelled;

TEST(FrameNumbers, sixteen_bits_wrap_to_one)
{
    const FrameNumbers numbers(FrameNumbering::GigE16);
    EXPECT_EQ(numbers.steps(65535, 1), 1);
    EXPECT_EQ(numbers.steps(1, 65535), -1);
    EXPECT_EQ(numbers.steps(65530, 3), 8);
    EXPECT_TRUE(numbers.apart(10, 11, 65536));
    EXPECT_FALSE(numbers.apart(10, 11, 2));
    EXPECT_FALSE(numbers.valid(0));
    EXPECT_FALSE(numbers.valid(65536));
}

TEST(FrameNumbers, sixty_four_bits_do_not_wrap)
{
    const FrameNumbers extended(FrameNumbering::GigE64);
    EXPECT_EQ(extended.steps(65535, 65536), 1);
    EXPECT_FALSE(extended.valid(0));
    EXPECT_TRUE(FrameNumbers(FrameNumbering::Usb64).valid(0));
}

TEST(SyncLine, the_first_sweep_shows_which_trigger_is_which_frame)
{
    Bench bench(10);
    EXPECT_EQ(bench.run().size(), 9U * 6U);
    EXPECT_EQ(bench.labeller.counts().lost, 0U);
    EXPECT_EQ(bench.labeller.counts().dropped_sweeps, 0U);
}

TEST(SyncLine, a_label_knows_when_its_trigger_was)
{
    Bench bench(3);
    const auto labels = bench.run();
    ASSERT_FALSE(labels.empty());
    EXPECT_NEAR(static_cast<double>(*labels[2].trigger_ns), 1e9 + 8 * period, 1e5);
}

TEST(SyncLine, a_lost_frame_leaves_the_others_their_labels)
{
    Bench bench(10);
    bench.erase(bench.frame(4, 2));
    EXPECT_EQ(bench.run().size(), 9U * 6U - 1U);
    EXPECT_EQ(bench.labeller.counts().lost, 1U);
}

TEST(SyncLine, a_trigger_that_the_camera_missed_drops_the_rest_of_its_sweep)
{
    Bench bench(10);
    const std::size_t missed = bench.frame(4, 2);
    bench.erase(missed);
    for (std::size_t i = missed; i < bench.events.size(); i++)
        bench.events[i].frame.id--;
    EXPECT_EQ(bench.run().size(), 9U * 6U - 4U);
    EXPECT_EQ(bench.labeller.counts().dropped_sweeps, 1U);
    EXPECT_EQ(bench.labeller.counts().lost, 0U);
}

TEST(SyncLine, a_lost_edge_drops_its_sweep)
{
    Bench bench(10);
    bench.erase(bench.edge(5));
    EXPECT_EQ(bench.run().size(), 8U * 6U);
    EXPECT_EQ(bench.labeller.counts().dropped_sweeps, 1U);
    EXPECT_EQ(bench.rhythm.wrong_edges(), 0U);
}

TEST(SyncLine, an_edge_out_of_the_rhythm_is_counted_and_not_believed)
{
    Bench bench(10);
    RigEvent wrong = bench.events[bench.edge(5)];
    wrong.time_ns += 2 * period;
    const auto behind = static_cast<std::ptrdiff_t>(bench.frame(5, 1));
    bench.events.insert(bench.events.begin() + behind, wrong);
    EXPECT_EQ(bench.run().size(), 9U * 6U);
    EXPECT_EQ(bench.rhythm.wrong_edges(), 1U);
}

TEST(SyncLine, a_frame_that_comes_twice_has_one_label)
{
    Bench bench(10);
    const RigEvent twice = bench.events[bench.frame(4, 2)];
    bench.events.insert(bench.events.begin() + static_cast<std::ptrdiff_t>(bench.frame(4, 3)), twice);
    EXPECT_EQ(bench.run().size(), 9U * 6U);
    EXPECT_EQ(bench.labeller.counts().doubled, 1U);
}

TEST(SyncLine, a_first_frame_that_never_came_is_noticed)
{
    Bench bench(10);
    bench.erase(bench.frame(0, 0));
    EXPECT_EQ(bench.run().size(), 0U);
    EXPECT_TRUE(bench.labeller.lost());
}

TEST(SyncLine, frames_that_all_come_late_at_first_cost_only_those_sweeps)
{
    Bench bench(10);
    for (RigEvent &event : bench.events)
        if (event.kind == RigEvent::Frame && event.sweep < 3)
            event.frame.arrival_ns += 2 * period;
    EXPECT_EQ(bench.run().size(), 7U * 6U - 1U);
    EXPECT_FALSE(bench.labeller.lost());
}

TEST(SyncLine, frames_that_come_faster_than_the_first_ones_keep_their_labels)
{
    Bench bench(10);
    for (RigEvent &event : bench.events)
        if (event.kind == RigEvent::Frame && event.sweep < 3)
            event.frame.arrival_ns += period * 6 / 10;
    EXPECT_EQ(bench.run().size(), 9U * 6U);
    EXPECT_FALSE(bench.labeller.lost());
}

/* Who could not know better took a late frame for one of a later trigger; it ends when frames are late no
 * more.
 */
TEST(SyncLine, a_clock_that_jumped_by_what_frames_lag_is_found_when_the_lag_ends)
{
    Bench bench(10);
    for (RigEvent &event : bench.events) {
        if (event.kind != RigEvent::Frame || event.sweep < 4)
            continue;
        event.frame.camera_ns += period;
        event.frame.arrival_ns += event.sweep < 6 ? period : 0;
    }
    bench.labels_may_be_wrong_until = 6;
    EXPECT_LT(bench.run().size(), 5U * 6U);
    EXPECT_TRUE(bench.labeller.lost());
}

/* Over a slow link a frame that is a little late could be that of the next trigger, and early. */
TEST(SyncLine, a_clock_that_was_set_is_not_believed_by_late_frames)
{
    Rig rig = paper_rig();
    rig.transfer_ns = period * 85 / 100;
    Bench bench(10, rig);
    for (RigEvent &event : bench.events) {
        if (event.kind != RigEvent::Frame || event.sweep < 4)
            continue;
        event.frame.camera_ns += period;
        event.frame.arrival_ns += period * 3 / 10;
    }
    EXPECT_EQ(bench.run().size(), 3U * 6U);
    EXPECT_TRUE(bench.labeller.lost());
}

TEST(SyncLine, nor_is_one_that_was_set_while_the_triggers_rested)
{
    Rig rig = paper_rig();
    rig.transfer_ns = period * 85 / 100;
    Bench bench(20, rig);
    bench.pause_before(8, 1'003'000'000, period * 3 / 10);
    for (RigEvent &event : bench.events)
        if (event.kind == RigEvent::Frame && event.sweep >= 8)
            event.frame.camera_ns += period;
    EXPECT_EQ(bench.run().size(), 7U * 6U);
    EXPECT_TRUE(bench.labeller.lost());
}

TEST(SyncLine, a_slow_link_does_not_look_like_a_missed_trigger)
{
    Rig rig = paper_rig();
    rig.transfer_ns = period;
    EXPECT_TRUE(Bench(10, rig).run().empty()) << "nobody knows how fast the link is";
    rig.timing.transfer_ns = period * 9 / 10;
    rig.transfer_ns = period / 10;
    EXPECT_EQ(Bench(10, rig).run().size(), 9U * 6U);
}

TEST(SyncLine, a_clock_that_was_set_needs_a_start_from_rest)
{
    Bench bench(10);
    for (RigEvent &event : bench.events)
        if (event.kind == RigEvent::Frame && event.sweep >= 4)
            event.frame.camera_ns -= 20 * period + period / 2;
    EXPECT_EQ(bench.run().size(), 3U * 6U);
    EXPECT_TRUE(bench.labeller.lost());
}

TEST(SyncLine, ten_seconds_without_triggers_cost_two_sweeps)
{
    Bench bench(20);
    bench.pause_before(8, 10'003'000'000, 0);
    EXPECT_EQ(bench.run().size(), (20U - 1U - 2U) * 6U);
}

TEST(SyncLine, frames_that_lag_after_a_pause_are_not_taken_for_later_ones)
{
    Bench bench(20);
    bench.pause_before(8, 13'000'000'000, period);
    EXPECT_EQ(bench.run().size(), (8U - 1U) * 6U);
    EXPECT_TRUE(bench.labeller.lost());
}

TEST(SentTriggers, label_the_frames_they_were_sent_for)
{
    const Rig rig = paper_rig();
    dff::SentTriggers triggers(rig.timing);
    dff::TriggerLabeller labeller(rig.timing, FrameNumbers(FrameNumbering::Usb64), triggers);
    labeller.start(PlaneLabeller::Beginning::FromRest, 0);
    unsigned labels = 0;
    for (int i = 0; i < 60; i++) {
        const std::int64_t sent_ns = 1'000'000'000 + i * period + (i % 3) * 400'000;
        triggers.sent({i, sent_ns});
        dff::CameraFrame frame{static_cast<std::uint64_t>(i), sent_ns + 500'000, sent_ns + 7'200'000};
        const auto verdict = labeller.label(frame);
        labels += verdict.label.has_value();
        if (verdict.label) {
            EXPECT_EQ(verdict.label->plane, static_cast<unsigned>(i % 6));
        }
    }
    EXPECT_EQ(labels, 60U - 6U);
}

TEST(Counting, gives_up_when_the_triggers_rest)
{
    const Rig rig = paper_rig();
    dff::CountingLabeller labeller(rig.timing, FrameNumbers(FrameNumbering::GigE16));
    labeller.start(PlaneLabeller::Beginning::UnderWay, 0);
    const auto frame = [](std::uint64_t id, std::int64_t time_ns) {
        return dff::CameraFrame{id, time_ns, time_ns + 7'000'000};
    };
    for (unsigned i = 0; i < 9; i++) {
        const auto verdict =
            labeller.label(frame(65530 + i > 65535 ? 65530 + i - 65535 : 65530 + i, i * period + 1));
        ASSERT_TRUE(verdict.label);
        EXPECT_EQ(verdict.label->plane, i % 6);
    }
    EXPECT_EQ(labeller.label(frame(4, 40 * period)).reason, Unlabelled::Disagree);
    EXPECT_TRUE(labeller.lost());
    EXPECT_FALSE(labeller.label(frame(5, 41 * period)).label);
    labeller.start(PlaneLabeller::Beginning::UnderWay, 0);
    const auto again = labeller.label(frame(6, 42 * period));
    ASSERT_TRUE(again.label);
    EXPECT_EQ(again.label->plane, 0U);
    EXPECT_EQ(again.label->sweep, 2U);
}

namespace {

void watch(dff::LabelWatch &watch, int frames, const dff::FrameVerdict &verdict, std::uint64_t dropped = 0)
{
    for (int i = 0; i < frames; i++)
        watch.judged(verdict, dropped);
}

dff::FrameVerdict label_of(std::uint64_t sweep)
{
    return {dff::FrameLabel{sweep, 0, std::nullopt}, {}};
}

} // namespace

TEST(LabelWatch, tells_once_that_no_label_comes_and_why)
{
    for (const auto &[reason, word] :
         {std::pair(Unlabelled::Incomplete, "packets"), std::pair(Unlabelled::NoTrigger, "sync-line"),
          std::pair(Unlabelled::Disagree, "trigger=free-run")}) {
        dff::LabelWatch labels(6);
        watch(labels, 6 * 20 - 1, {std::nullopt, reason});
        EXPECT_EQ(labels.take_complaint(), "");
        watch(labels, 6 * 100, {std::nullopt, reason});
        EXPECT_NE(labels.take_complaint().find(word), std::string::npos);
        watch(labels, 6, label_of(1));
        watch(labels, 6 * 100, {std::nullopt, reason});
        EXPECT_EQ(labels.take_complaint(), "") << "told already";
    }
}

TEST(LabelWatch, another_cause_is_told_as_well)
{
    dff::LabelWatch labels(6);
    watch(labels, 6 * 20, {std::nullopt, Unlabelled::NoTrigger});
    EXPECT_NE(labels.take_complaint(), "");
    watch(labels, 6, label_of(1));
    watch(labels, 6 * 20, {std::nullopt, Unlabelled::Incomplete});
    EXPECT_NE(labels.take_complaint().find("packets"), std::string::npos);
}

TEST(LabelWatch, tells_of_sweeps_that_are_dropped_in_a_row)
{
    for (const bool whole_between : {false, true}) {
        dff::LabelWatch labels(6);
        for (std::uint64_t sweep = 1; sweep <= 30; sweep++) {
            watch(labels, 3, label_of(2 * sweep), sweep - 1);
            watch(labels, 3, {std::nullopt, Unlabelled::Disagree}, sweep);
            if (whole_between)
                watch(labels, 6, label_of(2 * sweep + 1), sweep);
        }
        EXPECT_EQ(labels.take_complaint().empty(), whole_between);
    }
}
