/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sync_cycle.h"

#include <algorithm>
#include <cmath>

namespace {

/* A frame may lie so far from its place, in slots. */
constexpr double tolerance = 0.25;
/* Frames in a row that prove a slot's length: with every second frame lost it would seem to be twice as long,
 * but not for so many at a stretch. */
constexpr unsigned proof_frames = 8;
/* Frames may be late by so many sweeps. */
constexpr std::size_t kept_sweeps = 64;

} // namespace

void SyncCycle::add_edge(uint64_t time_ns)
{
    double slot_ns = 0;
    if (!sweeps_.empty()) {
        const uint64_t passed = time_ns - sweeps_.back().begin_ns;
        const uint64_t whole = interval_ns_.value_or(passed);
        /* Edges may have been lost: so many sweeps lie between this one and the last. */
        const double sweeps = std::round(static_cast<double>(passed) / static_cast<double>(whole));
        const double off = std::abs(static_cast<double>(passed) - sweeps * static_cast<double>(whole));
        const double slot = static_cast<double>(whole) / slots_;
        const bool in_step = sweeps >= 1 && off <= tolerance * slot;
        if (in_step && interval_ns_)
            slot_ns = sweeps > 1 ? slot : static_cast<double>(passed) / slots_;
        if (!in_step)
            in_row_ = 0;
        if (!in_step || sweeps <= 1)
            interval_ns_ = passed;
    }
    sweeps_.push_back({time_ns, edges_++, slot_ns});
    if (sweeps_.size() > kept_sweeps)
        sweeps_.pop_front();
}

/* The sweep that a frame belongs to: its plane 0 may be stamped a little before the edge. */
std::optional<SyncCycle::Sweep> SyncCycle::sweep_at(uint64_t time_ns) const
{
    const auto begun = [time_ns](const Sweep &sweep) {
        return static_cast<double>(time_ns) >=
               static_cast<double>(sweep.begin_ns) - tolerance * sweep.slot_ns;
    };
    const auto sweep = std::find_if(sweeps_.rbegin(), sweeps_.rend(), begun);
    return sweep != sweeps_.rend() ? std::optional(*sweep) : std::nullopt;
}

std::optional<PlaneLabel> SyncCycle::label(uint64_t time_ns)
{
    const auto sweep = sweep_at(time_ns);
    if (!sweep || sweep->slot_ns == 0)
        return std::nullopt;
    const double slots =
        (static_cast<double>(time_ns) - static_cast<double>(sweep->begin_ns)) / sweep->slot_ns;
    const auto slot = static_cast<uint64_t>(std::llround(std::max(slots, 0.0)));
    const double off = slots - static_cast<double>(slot);
    const bool misfit = std::abs(off) > tolerance;
    if (sweep->number != number_)
        void_ = false;
    if (misfit)
        misfit_ns_ = std::llround(off * sweep->slot_ns);
    void_ = void_ || misfit || (sweep->number == number_ && slot <= slot_);

    const double passed = (static_cast<double>(time_ns) - static_cast<double>(time_ns_)) / sweep->slot_ns;
    if (misfit)
        in_row_ = 0;
    else if (in_row_ < proof_frames)
        in_row_ = std::abs(passed - 1) <= 2 * tolerance ? in_row_ + 1 : 0;

    number_ = sweep->number;
    slot_ = slot;
    time_ns_ = time_ns;
    if (void_ || slot >= slots_ || in_row_ < proof_frames)
        return std::nullopt;
    return label_of(sweep->number, slot);
}

PlaneLabel SyncCycle::label_of(uint64_t number, uint64_t slot) const
{
    if (slots_ == planes_)
        return {number, static_cast<unsigned>(slot)};
    if (slot < planes_)
        return {2 * number, static_cast<unsigned>(slot)};
    return {2 * number + 1, static_cast<unsigned>(slots_ - 1 - slot)};
}
