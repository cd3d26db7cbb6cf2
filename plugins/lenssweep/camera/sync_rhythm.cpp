/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sync_rhythm.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace dff {

namespace {

constexpr std::size_t edges_kept = 16;
constexpr std::size_t edges_of_a_rhythm = 3;

std::int64_t rounded(std::int64_t value, std::int64_t unit)
{
    return (value >= 0 ? value + unit / 2 : value - unit / 2) / unit;
}

} // namespace

void SyncRhythm::restart()
{
    edges_.clear();
    first_.reset();
    doubted_ns_.clear();
    fitting_ = 0;
    contradicted_ = false;
    rhythm_++;
}

/* Empty if the two are not whole sweeps apart. The sequencer's clock and ours may differ by 200 ppm. */
std::optional<std::int64_t> SyncRhythm::sweeps_between(std::int64_t from_ns, std::int64_t to_ns) const
{
    const std::int64_t span_ns = to_ns - from_ns;
    const std::int64_t sweeps = rounded(span_ns, timing_.sweep_ns);
    if (std::abs(span_ns - sweeps * timing_.sweep_ns) > tolerance_ns())
        return std::nullopt;
    return sweeps;
}

bool SyncRhythm::believe(const Edge &edge)
{
    const auto later = std::find_if(edges_.begin(), edges_.end(),
                                    [&](const Edge &other) { return other.sweep >= edge.sweep; });
    if (later != edges_.end() && later->sweep == edge.sweep) {
        wrong_edges_++; /* doubled */
        return false;
    }
    edges_.insert(later, edge);
    if (edges_.size() > edges_kept)
        edges_.pop_front();
    next_sweep_ = std::max(next_sweep_, edge.sweep + 1);
    fitting_++;
    doubted_ns_.clear();
    if (!first_)
        first_ = Trigger{edge.sweep * timing_.planes, edge.time_ns};
    return true;
}

bool SyncRhythm::doubt(std::int64_t time_ns)
{
    wrong_edges_++;
    contradicted_ = true;
    if (!doubted_ns_.empty() && sweeps_between(doubted_ns_.back(), time_ns) != 1)
        doubted_ns_.clear();
    doubted_ns_.push_back(time_ns);
    if (doubted_ns_.size() < edges_of_a_rhythm)
        return false;
    const std::vector<std::int64_t> rhythm = std::exchange(doubted_ns_, {});
    restart();
    for (const std::int64_t edge_ns : rhythm)
        believe({next_sweep_, edge_ns});
    return true;
}

bool SyncRhythm::edge(std::int64_t time_ns)
{
    if (edges_.empty())
        return believe({next_sweep_, time_ns});
    const Edge &last = edges_.back();
    const auto sweeps = sweeps_between(last.time_ns, time_ns);
    return sweeps ? believe({last.sweep + *sweeps, time_ns}) : doubt(time_ns);
}

std::optional<Trigger> SyncRhythm::nearest(std::int64_t time_ns) const
{
    const auto later = std::find_if(edges_.begin(), edges_.end(), [&](const Edge &edge) {
        return edge.time_ns >= time_ns + timing_.period_ns / 2;
    });
    if (later == edges_.begin())
        return std::nullopt;
    const Edge &edge = *std::prev(later);
    const std::int64_t plane = rounded(time_ns - edge.time_ns, timing_.period_ns);
    if (plane >= timing_.planes)
        return std::nullopt;
    return Trigger{edge.sweep * timing_.planes + plane, edge.time_ns + plane * timing_.period_ns};
}

std::int64_t SyncRhythm::time_of(std::int64_t index) const
{
    const std::int64_t planes = timing_.planes;
    const std::int64_t plane = (index % planes + planes) % planes;
    const std::int64_t sweep = (index - plane) / planes;
    const Edge &nearest = *std::min_element(edges_.begin(), edges_.end(), [&](const Edge &a, const Edge &b) {
        return std::abs(a.sweep - sweep) < std::abs(b.sweep - sweep);
    });
    return nearest.time_ns + (sweep - nearest.sweep) * timing_.sweep_ns + plane * timing_.period_ns;
}

} // namespace dff
