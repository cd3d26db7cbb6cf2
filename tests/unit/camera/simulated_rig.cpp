/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "simulated_rig.h"

#include <algorithm>

namespace {

bool happens(double probability, std::mt19937_64 &random)
{
    return std::bernoulli_distribution(probability)(random);
}

std::int64_t up_to(std::int64_t limit, std::mt19937_64 &random)
{
    return limit <= 0 ? 0 : std::uniform_int_distribution<std::int64_t>(0, limit)(random);
}

std::uint64_t next_id(Rig &rig)
{
    rig.last_id++;
    if (rig.numbering == dff::FrameNumbering::GigE16 && rig.last_id > 65535)
        rig.last_id = 1;
    return rig.last_id;
}

void play_edge(const Rig &rig, std::int64_t trigger_ns, std::mt19937_64 &random,
               std::vector<RigEvent> &events)
{
    const std::int64_t time_ns = trigger_ns + rig.edge_off_ns + up_to(50'000, random);
    const std::int64_t period_ns = rig.timing.period_ns;
    const auto see = [&](std::int64_t at_ns, std::int64_t late_ns) {
        events.push_back({RigEvent::Edge, at_ns + late_ns + 20'000, at_ns, {}, 0, 0});
    };
    if (!happens(rig.faults.edge_lost, random))
        see(time_ns, happens(rig.faults.edge_late, random) ? up_to(3 * period_ns, random) : 0);
    if (happens(rig.faults.edge_doubled, random))
        see(time_ns + up_to(100'000, random), 0);
    if (happens(rig.faults.edge_wrong, random))
        see(time_ns + up_to(rig.timing.sweep_ns, random), 0);
}

void play_frame(Rig &rig, std::int64_t trigger_ns, std::uint64_t sweep, unsigned plane,
                std::mt19937_64 &random, std::vector<RigEvent> &events)
{
    if (happens(rig.faults.clock_jump, random))
        rig.clock_offset_ns += up_to(6 * rig.timing.period_ns, random) - 3 * rig.timing.period_ns;
    if (happens(rig.faults.ignored, random))
        return;
    RigEvent event{RigEvent::Frame, 0, 0, {}, sweep, plane};
    event.frame.id = next_id(rig);
    if (rig.has_clock)
        event.frame.camera_ns =
            trigger_ns + up_to(20'000, random) + rig.clock_offset_ns +
            static_cast<std::int64_t>(static_cast<double>(trigger_ns) * rig.drift_ppm * 1e-6);
    if (happens(rig.faults.lost, random))
        return;
    const std::int64_t late_ns =
        happens(rig.faults.late, random) ? up_to(3 * rig.timing.period_ns, random) : 0;
    event.frame.arrival_ns = trigger_ns + rig.timing.exposure_ns + rig.timing.transfer_ns + rig.transfer_ns +
                             rig.lag_ns + up_to(rig.jitter_ns, random) + late_ns;
    event.seen_ns = event.frame.arrival_ns;
    events.push_back(event);
    if (!happens(rig.faults.doubled, random))
        return;
    event.frame.arrival_ns += up_to(rig.timing.period_ns, random);
    event.seen_ns = event.frame.arrival_ns;
    events.push_back(event);
}

} // namespace

std::vector<RigEvent> play(Rig &rig, std::int64_t begin_ns, std::uint64_t first_sweep, unsigned sweeps,
                           std::mt19937_64 &random)
{
    std::vector<RigEvent> events;
    const std::int64_t flyback_ns = rig.timing.sweep_ns - rig.timing.planes * rig.timing.period_ns;
    std::int64_t trigger_ns = begin_ns;
    std::uint64_t lag_ends = 0;
    std::uint64_t edges_off_end = 0;
    rig.lag_ns = 0;
    rig.edge_off_ns = 0;
    for (std::uint64_t sweep = first_sweep; sweep < first_sweep + sweeps; sweep++) {
        if (sweep >= lag_ends)
            rig.lag_ns = 0;
        /* That a camera always was as slow, nobody could tell. */
        if (sweep >= first_sweep + 5 && happens(rig.faults.lag, random)) {
            rig.lag_ns = up_to(6 * rig.timing.period_ns, random);
            lag_ends = sweep + 1 + random() % 8;
        }
        if (sweep >= edges_off_end)
            rig.edge_off_ns = 0;
        if (happens(rig.faults.edges_off, random)) {
            rig.edge_off_ns = up_to(rig.timing.planes - 1, random) * rig.timing.period_ns;
            edges_off_end = sweep + 3 + random() % 6;
        }
        for (unsigned plane = 0; plane < rig.timing.planes; plane++) {
            rig.triggers_ns.push_back(trigger_ns);
            if (plane == 0)
                play_edge(rig, trigger_ns, random, events);
            play_frame(rig, trigger_ns, sweep, plane, random, events);
            trigger_ns += rig.timing.period_ns;
            if (happens(rig.faults.pause, random))
                trigger_ns += up_to(2'000'000'000, random);
        }
        trigger_ns += flyback_ns;
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const RigEvent &a, const RigEvent &b) { return a.seen_ns < b.seen_ns; });
    return events;
}
