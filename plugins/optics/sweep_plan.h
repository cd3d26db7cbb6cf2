/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <span>
#include <vector>

namespace dff {

/* The planes of one sweep: plane 0 is the nearest, powers are object vergences in dioptres and fall from
 * plane to plane. Between planes the vergence is piecewise linear in the plane position z. */
class SweepPlan {
public:
    static constexpr unsigned min_planes = 2;
    static constexpr unsigned max_planes = 64;

    /* `planes` planes, even in dioptres from `near` down to `far`.
     * Throws std::invalid_argument if planes is outside [2, 64] or near <= far. */
    static SweepPlan even(unsigned planes, double near, double far);

    /* Planes at the given vergences. Throws std::invalid_argument unless there are 2 to 64, strictly falling.
     */
    static SweepPlan at(std::span<const double> powers);

    unsigned planes() const { return static_cast<unsigned>(powers_.size()); }
    double near() const { return powers_.front(); }
    double far() const { return powers_.back(); }
    double power(unsigned plane) const { return powers_.at(plane); }

    /* Vergence in dioptres at plane position z, clamped to [0, planes - 1]. */
    double power_at(double z) const;

    /* Plane position of a vergence in dioptres: the inverse of power_at(), clamped to the sweep. */
    double position_of(double power) const;

private:
    explicit SweepPlan(std::vector<double> powers);

    std::vector<double> powers_;
};

} // namespace dff
