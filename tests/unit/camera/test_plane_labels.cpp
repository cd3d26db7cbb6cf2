/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* Thousands of sequences in which frames and edges are lost, doubled, late and out of order: not one label
 * may be wrong. DFF_SEQUENCES says how many, DFF_SEED where to begin. */
#include "lenssweep/camera/counting_labeller.h"
#include "lenssweep/camera/sync_rhythm.h"
#include "lenssweep/camera/trigger_labeller.h"
#include "simulated_rig.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <map>
#include <string>

using dff::PlaneLabeller;

namespace {

unsigned environment(const char *name, unsigned fallback)
{
    const char *value = std::getenv(name);
    return value ? static_cast<unsigned>(std::stoul(value)) : fallback;
}

double between(double low, double high, std::mt19937_64 &random)
{
    return std::uniform_real_distribution<double>(low, high)(random);
}

bool perhaps(std::mt19937_64 &random)
{
    return random() % 2 == 0;
}

Rig random_rig(std::mt19937_64 &random)
{
    Rig rig;
    rig.timing.planes = 2 + static_cast<unsigned>(random() % 9);
    rig.timing.period_ns = static_cast<std::int64_t>(between(2e6, 20e6, random));
    const auto period = static_cast<double>(rig.timing.period_ns);
    rig.timing.exposure_ns = static_cast<std::int64_t>(period * between(0.2, 0.95, random));
    rig.timing.sweep_ns = rig.timing.planes * rig.timing.period_ns;
    if (perhaps(random))
        rig.timing.sweep_ns += static_cast<std::int64_t>(period * between(0, 2, random));
    rig.numbering = static_cast<dff::FrameNumbering>(random() % 3);
    rig.last_id = perhaps(random) ? 0 : 65535 - random() % 300;
    rig.drift_ppm = between(-100, 100, random);
    rig.clock_offset_ns = static_cast<std::int64_t>(between(0, 1e15, random));
    rig.transfer_ns = static_cast<std::int64_t>(period * between(0.05, 0.8, random));
    if (perhaps(random))
        rig.timing.transfer_ns = static_cast<std::int64_t>(period * between(0, 0.95, random));
    rig.jitter_ns = static_cast<std::int64_t>(period * between(0, 0.05, random));
    return rig;
}

Faults random_faults(std::mt19937_64 &random)
{
    Faults faults;
    const double most = perhaps(random) ? 0.02 : 0.2;
    for (double *fault : {&faults.ignored, &faults.lost, &faults.doubled, &faults.late, &faults.edge_lost,
                          &faults.edge_doubled, &faults.edge_late, &faults.edge_wrong})
        *fault = perhaps(random) ? between(0, most, random) : 0;
    faults.pause = random() % 4 == 0 ? between(0, 0.02, random) : 0;
    /* A clock that jumps by just the time of a trigger that is missed in the same moment fools anyone. */
    if (faults.ignored == 0 && faults.pause == 0)
        faults.clock_jump = between(0, 0.02, random);
    return faults;
}

/* Holds labels against the truth. */
class Judge {
public:
    void judge(const RigEvent &event, const dff::FrameLabel &label)
    {
        labels++;
        const auto sweep = truth_.emplace(label.sweep, event.sweep).first->second;
        const auto back = labelled_.emplace(event.sweep, label.sweep).first->second;
        if (label.plane != event.plane || sweep != event.sweep || back != label.sweep)
            wrong++;
    }

    unsigned labels = 0;
    unsigned wrong = 0;

private:
    std::map<std::uint64_t, std::uint64_t> truth_; /* labelled sweep -> true sweep */
    std::map<std::uint64_t, std::uint64_t> labelled_;
};

struct Tally {
    std::uint64_t frames = 0;
    std::uint64_t labels = 0;
    std::uint64_t wrong = 0;
};

/* Several starts of one rig, each of some sweeps. */
template <typename Labeller, typename OnEdge>
void run(Rig rig, Labeller &labeller, OnEdge on_edge, bool from_rest, std::mt19937_64 &random, Tally &tally)
{
    Judge judge;
    std::uint64_t sweep = 0;
    std::int64_t now_ns = 1'000'000'000;
    for (int start = 0; start < 3; start++) {
        const auto beginning =
            from_rest ? PlaneLabeller::Beginning::FromRest : PlaneLabeller::Beginning::UnderWay;
        const unsigned sweeps = 10 + static_cast<unsigned>(random() % 20);
        const auto events = play(rig, now_ns, sweep, sweeps, random);
        /* Under way: whoever listens begins in the middle. */
        const std::size_t skipped = from_rest ? 0 : random() % (2 * rig.timing.planes);
        labeller.start(beginning, now_ns);
        for (std::size_t i = skipped; i < events.size(); i++) {
            const RigEvent &event = events[i];
            if (event.kind == RigEvent::Edge) {
                on_edge(event.time_ns);
                continue;
            }
            const auto verdict = labeller.label(event.frame);
            if (verdict.label)
                judge.judge(event, *verdict.label);
            tally.frames++;
            if (labeller.lost() && !from_rest)
                labeller.start(beginning, event.seen_ns);
        }
        sweep += sweeps + 1;
        now_ns = (events.empty() ? now_ns : events.back().seen_ns) + 4 * rig.timing.sweep_ns;
    }
    tally.labels += judge.labels;
    tally.wrong += judge.wrong;
}

void run_synced(const Rig &rig, bool from_rest, std::mt19937_64 &random, Tally &tally)
{
    dff::SyncRhythm rhythm(rig.timing);
    dff::TriggerLabeller labeller(rig.timing, dff::FrameNumbers(rig.numbering), rhythm);
    run(
        rig, labeller, [&](std::int64_t time_ns) { rhythm.edge(time_ns); }, from_rest, random, tally);
}

} // namespace

TEST(PlaneLabels, without_faults_all_but_the_first_sweeps_have_labels)
{
    Tally rest;
    Tally under_way;
    for (unsigned seed = 0; seed < 100; seed++) {
        std::mt19937_64 random(seed);
        const Rig rig = random_rig(random);
        run_synced(rig, true, random, rest);
        run_synced(rig, false, random, under_way);
    }
    EXPECT_EQ(rest.wrong, 0U);
    EXPECT_EQ(under_way.wrong, 0U);
    EXPECT_GT(static_cast<double>(rest.labels), 0.9 * static_cast<double>(rest.frames));
    EXPECT_GT(static_cast<double>(under_way.labels), 0.7 * static_cast<double>(under_way.frames));
}

TEST(PlaneLabels, no_fault_makes_one_wrong_with_a_sync_line)
{
    const unsigned first = environment("DFF_SEED", 1000);
    const unsigned sequences = environment("DFF_SEQUENCES", 3000);
    Tally tally;
    for (unsigned seed = first; seed < first + sequences; seed++) {
        std::mt19937_64 random(seed);
        Rig rig = random_rig(random);
        rig.faults = random_faults(random);
        rig.has_clock = random() % 4 != 0;
        const bool from_rest = perhaps(random);
        /* Nor can a clock that jumps by just what frames lag be told, nor, under way, a lag from a slow link.
         */
        if (from_rest && rig.faults.clock_jump == 0)
            rig.faults.lag = perhaps(random) ? between(0, 0.2, random) : 0;
        const std::uint64_t before = tally.wrong;
        run_synced(rig, from_rest, random, tally);
        EXPECT_EQ(tally.wrong, before) << "seed " << seed;
    }
    EXPECT_GT(static_cast<double>(tally.labels), 0.3 * static_cast<double>(tally.frames));
    std::printf("%llu frames, %.1f %% labelled, %llu wrong\n", static_cast<unsigned long long>(tally.frames),
                100.0 * static_cast<double>(tally.labels) / static_cast<double>(tally.frames),
                static_cast<unsigned long long>(tally.wrong));
}

TEST(PlaneLabels, no_fault_makes_one_wrong_by_counting)
{
    const unsigned first = environment("DFF_SEED", 1000);
    const unsigned sequences = environment("DFF_SEQUENCES", 3000);
    Tally tally;
    for (unsigned seed = first; seed < first + sequences; seed++) {
        std::mt19937_64 random(seed);
        Rig rig = random_rig(random);
        rig.faults = random_faults(random);
        dff::CountingLabeller labeller(rig.timing, dff::FrameNumbers(rig.numbering));
        const std::uint64_t before = tally.wrong;
        run(
            rig, labeller, [](std::int64_t) {}, true, random, tally);
        EXPECT_EQ(tally.wrong, before) << "seed " << seed;
    }
    EXPECT_GT(tally.labels, 0U);
}
