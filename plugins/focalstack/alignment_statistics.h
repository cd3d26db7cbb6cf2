/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/stack_aligner.h"

#include <gst/gst.h>

#include <cstdint>
#include <string>
#include <vector>

namespace dff {

/* What focalstackalign tells of the stacks so far. */
class AlignmentStatistics {
public:
    /* Counts a stack, and keeps how its planes lay and how many pixels of the sensor were bad. */
    void add(std::vector<PlaneAlignment> planes, std::size_t bad_pixels);

    /* The property `stats`. */
    GstStructure *to_structure() const;

private:
    uint64_t stacks_ = 0;
    uint64_t untrusted_planes_ = 0;
    uint64_t bad_pixels_ = 0;
    std::vector<PlaneAlignment> planes_;
};

/* Of the planes that are not trusted because there is nothing in them, or of the others that are not: "3, 4
 * and 7" is said as "3, 4, 7". */
std::string numbers_of(std::span<const PlaneAlignment> alignments, bool blank);

} // namespace dff
