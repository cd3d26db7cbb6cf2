/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "frame_cycle.h"

#include <cstdint>
#include <optional>
#include <vector>

/* Looks whether a lens that goes to and fro stands where labels say. If it follows later than was told, then
 * what is in the picture is sharp in a later plane of each sweep: in a farther one on the way there, in a
 * nearer one on the way back. Noise and what moves do not know of the way.
 *
 * Frames of even sweeps are on the way there, those of the odd ones after them on the way back. Sharpness is
 * what block_sharpness() says. Three planes or more are needed. */
class SwingCheck {
public:
    using Sharpness = std::vector<double>;

    explicit SwingCheck(unsigned planes) : planes_(planes) {}

    /* Whether the sharpness of this frame is wanted: of two sweeps now and then. */
    bool wants(const PlaneLabel &label) const;
    void add(const PlaneLabel &label, Sharpness sharpness);

    /* By how many frames' times the lens is later than was told (or earlier: below 0); a little less than it
     * is, if there is noise. Nothing while that is not sure, or next to nothing. */
    std::optional<double> lag() const;

private:
    void conclude();
    void compare(size_t block, double &change, double &way) const;

    unsigned planes_;
    uint64_t next_ = 1;              /* pair of sweeps, the first one that is wanted */
    std::vector<Sharpness> there_{}; /* by plane; of the pair next_ */
    std::vector<Sharpness> back_{};

    /* One of each a pair: the change from there to back along the change from plane to plane, and twice the
     * latter. */
    std::vector<double> changes_;
    std::vector<double> ways_;
};
