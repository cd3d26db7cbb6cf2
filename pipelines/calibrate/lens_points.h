/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace dff {

/* Where a lens stood when something at a distance that was measured with a tape was sharp. */
struct LensPoint {
    double position; /* a code, in the maker's unit */
    double metres;

    double vergence() const { return 1.0 / metres; }
};

/* Points of a lens, the farthest first. */
class LensPoints {
public:
    /* Of "POSITION=METRES,POSITION=METRES,...". Throws std::invalid_argument with a user's text if that is
     * not two points or more whose positions only rise, or only fall, with the distance. */
    static LensPoints parse(const std::string &text);

    const std::vector<LensPoint> &points() const { return points_; }

    /* By how many dioptres the straight line between its neighbours misses the point that it misses most;
     * nothing of two points. */
    std::optional<double> largest_miss() const;

    /* The lens profile, as lens-profile takes it. Throws std::runtime_error with a user's text. */
    void write(const std::string &file, const std::string &lens) const;

    /* What the points are worth, in words. */
    std::string worth() const;

private:
    std::vector<LensPoint> points_;
};

} // namespace dff
