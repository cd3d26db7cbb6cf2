/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* Thousands of sequences in which frames and edges are lost, doubled, late and out of order, and counts of
 * triggers are read late or not at all: not one label may be wrong. DFF_SEQUENCES says how many, DFF_SEED
 * where to begin. */
#include "lenssweep/camera/plane_labeller.h"
#include "lenssweep/camera/trigger_labeller.h"
#include "lenssweep/camera/trigger_times.h"
#include "simulated_rig.h"

#include <algorithm>
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

/* What the host learns beside the frames. */
class Witnesses {
public:
    virtual ~Witnesses() = default;
    virtual void rest(const Rig &) {}
    virtual void until(const Rig &, std::int64_t /*now_ns*/) {}
    virtual void edge(const RigEvent &) {}
};

/* Several starts of one rig, each of some sweeps. */
void run(Rig rig, PlaneLabeller &labeller, Witnesses &witnesses, bool from_rest, std::mt19937_64 &random,
         Tally &tally)
{
    Judge judge;
    std::uint64_t sweep = 0;
    std::int64_t now_ns = 1'000'000'000;
    for (int start = 0; start < 3; start++) {
        const auto beginning =
            from_rest ? PlaneLabeller::Beginning::FromRest : PlaneLabeller::Beginning::UnderWay;
        witnesses.rest(rig);
        const unsigned sweeps = 10 + static_cast<unsigned>(random() % 20);
        const auto events = play(rig, now_ns, sweep, sweeps, random);
        /* Under way: whoever listens begins in the middle. */
        const std::size_t skipped = from_rest ? 0 : random() % (2 * rig.timing.planes);
        labeller.start(beginning, now_ns);
        for (std::size_t i = skipped; i < events.size(); i++) {
            const RigEvent &event = events[i];
            witnesses.until(rig, event.seen_ns);
            if (event.kind == RigEvent::Edge) {
                witnesses.edge(event);
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

class SyncLine : public Witnesses {
public:
    explicit SyncLine(const Rig &rig) : rhythm(rig.timing) {}
    void edge(const RigEvent &event) override { rhythm.edge(event.time_ns); }

    dff::SyncRhythm rhythm;
};

void run_synced(const Rig &rig, bool from_rest, std::mt19937_64 &random, Tally &tally)
{
    SyncLine line(rig);
    dff::TriggerLabeller labeller(rig.timing, dff::FrameNumbers(rig.numbering), line.rhythm);
    run(rig, labeller, line, from_rest, random, tally);
}

/* How the triggers are counted: half a period after each edge that is believed, the count is read over a bus.
 */
struct Bus {
    std::int64_t delay_ns = 0; /* to the begin of a reading, beside that, at the most */
    std::int64_t time_ns = 0;  /* and from there to its end */
    double fails = 0;          /* how often */
};

class CountedLine : public SyncLine {
public:
    CountedLine(const Rig &rig, const Bus &bus, std::uint64_t seed)
        : SyncLine(rig), count(rig.timing), timing_(rig.timing), bus_(bus), random_(seed),
          first_(static_cast<std::uint32_t>(seed))
    {
        first_ = 0U - first_ % 500; /* wraps soon */
    }

    void rest(const Rig &rig) override
    {
        reading_.reset();
        asked_ = false;
        const auto given = first_ + static_cast<std::uint32_t>(rig.triggers_ns.size());
        count.restart(fails() ? std::nullopt : std::optional(given));
    }

    void edge(const RigEvent &event) override
    {
        if (!rhythm.edge(event.time_ns))
            return;
        asked_ = reading_.has_value();
        if (!asked_)
            read_after(std::max(event.seen_ns, event.time_ns + timing_.period_ns / 2));
    }

    void until(const Rig &rig, std::int64_t now_ns) override
    {
        while (reading_ && reading_->after_ns <= now_ns) {
            finish(rig);
            const std::int64_t end_ns = reading_->after_ns;
            reading_.reset();
            if (std::exchange(asked_, false))
                read_after(end_ns);
        }
    }

    dff::TriggerCount count;

private:
    bool fails() { return std::bernoulli_distribution(bus_.fails)(random_); }

    std::int64_t moment(std::int64_t from_ns, std::int64_t to_ns)
    {
        return std::uniform_int_distribution(from_ns, to_ns)(random_);
    }

    void read_after(std::int64_t time_ns)
    {
        const std::int64_t before_ns = moment(time_ns, time_ns + bus_.delay_ns);
        reading_ = dff::CountReading{0, before_ns, moment(before_ns, before_ns + bus_.time_ns)};
    }

    void finish(const Rig &rig)
    {
        if (fails()) {
            count.withdraw();
            return;
        }
        const std::int64_t taken_ns = moment(reading_->before_ns, reading_->after_ns);
        const auto &given = rig.triggers_ns;
        const auto until = std::upper_bound(given.begin(), given.end(), taken_ns) - given.begin();
        reading_->count = first_ + static_cast<std::uint32_t>(until);
        count.read(*reading_, &rhythm);
    }

    dff::SweepTiming timing_;
    Bus bus_;
    std::mt19937_64 random_;
    std::uint32_t first_;                      /* what the sequencer had counted before us */
    std::optional<dff::CountReading> reading_; /* under way */
    bool asked_ = false;                       /* another one, after it */
};

/* The same sequence, with a count and, if there is a tally for it, without. */
void run_counted(const Rig &rig, const Bus &bus, std::uint64_t seed, Tally &counted, Tally *uncounted)
{
    std::mt19937_64 random(seed);
    CountedLine line(rig, bus, seed);
    dff::TriggerLabeller labeller(rig.timing, dff::FrameNumbers(rig.numbering), line.rhythm, &line.count);
    run(rig, labeller, line, true, random, counted);
    std::mt19937_64 again(seed);
    if (uncounted)
        run_synced(rig, true, again, *uncounted);
}

Bus random_bus(const Rig &rig, double longest_periods, std::mt19937_64 &random)
{
    const auto up_to = [&](double periods) {
        return static_cast<std::int64_t>(static_cast<double>(rig.timing.period_ns) *
                                         between(0, periods, random));
    };
    return {up_to(perhaps(random) ? 0.1 : 3), up_to(perhaps(random) ? 0.1 : longest_periods)};
}

void print(const char *what, const Tally &tally)
{
    std::printf("%s: %llu frames, %.1f %% labelled, %llu wrong\n", what,
                static_cast<unsigned long long>(tally.frames),
                100.0 * static_cast<double>(tally.labels) / static_cast<double>(tally.frames),
                static_cast<unsigned long long>(tally.wrong));
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
    print("sync line", tally);
}

/* Clocks that are set while the triggers rest, and edges at another plane, are what frames and edges cannot
 * tell. */
TEST(PlaneLabels, no_fault_makes_one_wrong_where_triggers_are_counted)
{
    const unsigned first = environment("DFF_SEED", 1000);
    const unsigned sequences = environment("DFF_SEQUENCES", 3000);
    Tally counted;
    Tally uncounted;
    for (unsigned seed = first; seed < first + sequences; seed++) {
        std::mt19937_64 random(seed);
        Rig rig = random_rig(random);
        rig.faults = random_faults(random);
        rig.has_clock = random() % 4 != 0;
        /* A pause between the two would fool one reading. */
        rig.faults.edges_off = perhaps(random) ? between(0, 0.1, random) : 0;
        rig.faults.pause = rig.faults.edges_off == 0 ? between(0, 0.02, random) : 0;
        if (rig.faults.ignored == 0)
            rig.faults.clock_jump = between(0, 0.02, random);
        const Bus bus = random_bus(rig, 0.5, random);
        const std::uint64_t before = counted.wrong;
        run_counted(rig, bus, seed, counted, &uncounted);
        EXPECT_EQ(counted.wrong, before) << "seed " << seed;
    }
    print("counted", counted);
    print("not counted", uncounted);
    EXPECT_GT(static_cast<double>(counted.labels), 0.2 * static_cast<double>(counted.frames));
    EXPECT_GT(uncounted.wrong, 0U) << "then the count tells nothing";
}

TEST(PlaneLabels, counts_that_cannot_be_read_take_no_label_away)
{
    for (unsigned seed = 0; seed < 100; seed++) {
        std::mt19937_64 random(seed);
        Rig rig = random_rig(random);
        rig.faults = random_faults(random);
        Bus bus = random_bus(rig, 3, random);
        bus.fails = 1;
        Tally counted;
        Tally uncounted;
        run_counted(rig, bus, seed, counted, &uncounted);
        EXPECT_EQ(counted.labels, uncounted.labels) << "seed " << seed;
    }
}

TEST(PlaneLabels, counts_that_are_read_now_and_then_cost_few_labels)
{
    Tally counted;
    Tally uncounted;
    for (unsigned seed = 0; seed < 300; seed++) {
        std::mt19937_64 random(seed);
        Rig rig = random_rig(random);
        rig.faults = random_faults(random);
        Bus bus = random_bus(rig, 3, random);
        bus.fails = between(0, 1, random);
        run_counted(rig, bus, seed, counted, &uncounted);
    }
    EXPECT_EQ(counted.wrong, 0U);
    EXPECT_GT(static_cast<double>(counted.labels), 0.95 * static_cast<double>(uncounted.labels));
    print("read now and then", counted);
    print("not counted", uncounted);
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
        Witnesses none;
        run(rig, labeller, none, true, random, tally);
        EXPECT_EQ(tally.wrong, before) << "seed " << seed;
    }
    EXPECT_GT(tally.labels, 0U);
}
