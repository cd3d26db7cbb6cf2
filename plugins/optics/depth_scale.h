/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "optics/sweep_plan.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace dff {

enum class DepthUnit { Index, Dioptre, Millimetre, Micrometre };

/* What the pixels of a 16-bit depth map mean: value = offset + scale * pixel, in `unit`. Pixel 0 is "no
 * value"; in every unit a smaller pixel is nearer. */
struct DepthScale {
    static constexpr uint16_t no_value = 0;
    static constexpr unsigned max_pixel = 65535;

    DepthUnit unit;
    double scale;
    double offset;

    double value(uint16_t pixel) const { return offset + scale * pixel; }

    bool operator==(const DepthScale &) const = default;
};

/* Turns plane positions z in [0, planes - 1] into pixels of a depth map and back, for one sweep and one unit.
 */
class DepthEncoder {
public:
    /* pixel = 1 + round(65534 z / (planes - 1)) */
    static DepthEncoder index(unsigned planes);

    /* pixel = 1 + round(65534 (near - d) / (near - far)), d the vergence at z */
    static DepthEncoder dioptre(const SweepPlan &plan);

    /* The same for maps whose pixels go from `near` to `far` dioptres, which need not be the plan's ends. */
    static DepthEncoder dioptre(const SweepPlan &plan, double near, double far);

    /* pixel = distance in whole millimetres, from 1 up, saturating at 65535 (infinity cannot be said). */
    static DepthEncoder millimetre(const SweepPlan &plan);

    /* For stage positions (microscopes): pixel 1 at the plane 0 position, 65535 at the last one.
     * `positions_um` holds one position a plane, strictly monotone; throws std::invalid_argument otherwise.
     */
    static DepthEncoder micrometre(std::vector<double> positions_um);

    const DepthScale &scale() const { return scale_; }
    unsigned planes() const { return planes_; }

    /* Pixel of plane position z; z outside the sweep is clamped, NaN gives DepthScale::no_value. */
    uint16_t encode(double z) const;

    /* By how many pixels the map changes from plane to plane, around plane position z; up to max_pixel. */
    double slope(double z) const;

    /* Plane position of a pixel; empty for DepthScale::no_value. */
    std::optional<double> decode(uint16_t pixel) const;

private:
    DepthEncoder(unsigned planes, DepthScale scale) : planes_(planes), scale_(scale) {}

    double value_at(double z) const;

    unsigned planes_;
    DepthScale scale_;
    std::optional<SweepPlan> plan_;
    std::vector<double> positions_um_;
};

} // namespace dff
