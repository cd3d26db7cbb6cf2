/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "simulated_rig.h"

#include "lenssweep/camera/trigger_labeller.h"
#include "lenssweep/camera/trigger_times.h"

#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <optional>
#include <utility>

inline constexpr std::int64_t period = 6'400'000;

inline Rig paper_rig()
{
    Rig rig;
    rig.timing = {6, period, 6 * period, 6'000'000};
    rig.transfer_ns = 1'000'000;
    rig.clock_offset_ns = 77'000'000'000;
    return rig;
}

/* The paper's rig with a sync line, and what its labeller makes of it. */
struct Bench {
    explicit Bench(unsigned sweeps, const Rig &parts = paper_rig())
        : rig(parts), events(play(rig, 1'000'000'000, 0, sweeps, random))
    {
    }

    /* Labels of the frames that have one. */
    std::vector<dff::FrameLabel> run()
    {
        labeller.start(dff::PlaneLabeller::Beginning::FromRest, 1'000'000'000);
        std::vector<dff::FrameLabel> labels;
        std::optional<std::int64_t> reading_ns;
        for (const RigEvent &event : events) {
            const std::int64_t now_ns = std::max(event.time_ns, event.frame.arrival_ns);
            if (reading_ns && *reading_ns <= now_ns)
                read_count(*std::exchange(reading_ns, std::nullopt));
            if (event.kind == RigEvent::Edge) {
                if (rhythm.edge(event.time_ns) && read_count)
                    reading_ns = event.time_ns + period / 2;
                continue;
            }
            const auto verdict = labeller.label(event.frame);
            if (!verdict.label)
                continue;
            if (event.sweep >= labels_may_be_wrong_until) {
                EXPECT_EQ(verdict.label->plane, event.plane);
                EXPECT_EQ(verdict.label->sweep, event.sweep);
            }
            labels.push_back(*verdict.label);
        }
        return labels;
    }

    /* Position of a frame among the events. */
    std::size_t frame(std::uint64_t sweep, unsigned plane) const
    {
        for (std::size_t i = 0; i < events.size(); i++)
            if (events[i].kind == RigEvent::Frame && events[i].sweep == sweep && events[i].plane == plane)
                return i;
        return events.size();
    }

    std::size_t edge(unsigned number) const
    {
        std::size_t i = 0;
        for (; i < events.size(); i++)
            if (events[i].kind == RigEvent::Edge && number-- == 0)
                break;
        return i;
    }

    void erase(std::size_t index) { events.erase(events.begin() + static_cast<std::ptrdiff_t>(index)); }

    /* The triggers rest before a sweep; the frames after that come late. */
    void pause_before(std::uint64_t sweep, std::int64_t pause_ns, std::int64_t late_ns)
    {
        for (std::size_t i = sweep * rig.timing.planes; i < rig.triggers_ns.size(); i++)
            rig.triggers_ns[i] += pause_ns;
        for (std::size_t i = edge(static_cast<unsigned>(sweep)); i < events.size(); i++) {
            RigEvent &event = events[i];
            if (event.kind == RigEvent::Frame && event.sweep < sweep)
                continue;
            event.time_ns += pause_ns;
            event.frame.camera_ns += pause_ns;
            event.frame.arrival_ns += pause_ns + late_ns;
        }
        std::stable_sort(events.begin(), events.end(), [](const RigEvent &a, const RigEvent &b) {
            return std::max(a.time_ns, a.frame.arrival_ns) < std::max(b.time_ns, b.frame.arrival_ns);
        });
    }

    /* The count is right, and read after each edge. */
    void count_triggers()
    {
        count.restart(0);
        read_count = [this](std::int64_t time_ns) {
            count.read({given(time_ns), time_ns, time_ns}, &rhythm);
        };
    }

    std::uint32_t given(std::int64_t time_ns) const
    {
        return static_cast<std::uint32_t>(
            std::count_if(rig.triggers_ns.begin(), rig.triggers_ns.end(),
                          [&](auto trigger_ns) { return trigger_ns <= time_ns; }));
    }

    std::uint64_t labels_may_be_wrong_until = 0;
    std::mt19937_64 random{1};
    Rig rig;
    std::vector<RigEvent> events;
    dff::SyncRhythm rhythm{rig.timing};
    dff::TriggerCount count{rig.timing}; /* has no word until it is restarted */
    std::function<void(std::int64_t)> read_count;
    dff::TriggerLabeller labeller{rig.timing, dff::FrameNumbers(dff::FrameNumbering::GigE16), rhythm, &count};
};
