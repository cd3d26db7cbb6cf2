/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>

namespace dff {

/* What becomes of a frame. Only a taken one goes into a stack. */
enum class FrameVerdict {
    Taken,
    Repeated, /* this plane of this sweep is there already */
    Late,     /* its sweep is over */
};

constexpr unsigned longest_stack = 64;

/* A leap of the sweep's number by more is taken for a new numbering, not for a loss. */
constexpr uint64_t longest_gap = 256;

/* So many late frames in a row mean a new numbering too. Fewer than 16 may just be out of order. */
constexpr unsigned longest_delay(unsigned planes)
{
    return planes > 16 ? planes : 16;
}

/* `plane` is below longest_stack; the remainder makes that plain to whoever reasons without knowing it. */
constexpr uint64_t plane_bit(unsigned plane)
{
    return uint64_t{1} << (plane % longest_stack);
}

constexpr uint64_t all_planes(unsigned planes)
{
    return ~uint64_t{0} >> (longest_stack - planes);
}

/* The way a sweep runs through the planes, told from the first plane seen of it. A triangle's sweeps
 * alternate. */
class SweepDirection {
public:
    SweepDirection(unsigned planes, unsigned first_plane) : outwards_(first_plane < (planes + 1) / 2) {}

    /* Whether `plane` comes earlier in the sweep than `other`. */
    bool before(unsigned plane, unsigned other) const { return outwards_ ? plane < other : plane > other; }

private:
    bool outwards_;
};

} // namespace dff
