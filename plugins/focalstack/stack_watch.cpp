/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/stack_watch.h"

#include "focalstack/frame_verdict.h"

namespace dff {

static std::string names_of(uint64_t planes, unsigned count)
{
    std::string names;
    for (unsigned z = 0; z < count; z++)
        if (planes & plane_bit(z))
            names += (names.empty() ? "" : ", ") + std::to_string(z);
    return names;
}

StackWatch::Cause StackWatch::cause(const MuxStatistics &counts) const
{
    const uint64_t half = (counts.frames - at_last_stack_.frames) / 2;
    if (counts.damaged - at_last_stack_.damaged >= half)
        return Damaged;
    if (counts.repeated - at_last_stack_.repeated >= half)
        return Repeated;
    if (counts.late - at_last_stack_.late >= half)
        return Late;
    return Missing;
}

std::string StackWatch::look(const MuxStatistics &counts, unsigned planes)
{
    if (counts.stacks != at_last_stack_.stacks) {
        at_last_stack_ = counts;
        return "";
    }
    const uint64_t frames = counts.frames - at_last_stack_.frames;
    if (frames < uint64_t{patience_sweeps} * planes)
        return "";
    const Cause why = cause(counts);
    if (told_ & why)
        return "";
    told_ |= why;

    const std::string begin = "No stack could be made of the last " + std::to_string(frames) + " frames: ";
    const uint64_t never_there = counts.never_there & all_planes(planes);
    if (why == Damaged)
        return begin + "most of them could not be read.";
    if (why == Repeated)
        return begin + "the same planes of the same sweep come again and again.";
    if (why == Late)
        return begin + "they are of sweeps that are over.";
    if (never_there == 0 || never_there == all_planes(planes))
        return begin + "each sweep lacks some of its " + std::to_string(planes) + " planes.";
    return begin + "of the " + std::to_string(planes) +
           " planes of each sweep these never come: " + names_of(never_there, planes) + ".";
}

} // namespace dff
