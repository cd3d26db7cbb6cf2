/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "optics/depth_scale.h"

#include <optional>
#include <vector>

namespace dff {

/* What is known of a depth map's pixels. */
struct DepthFacts {
    DepthScale scale{DepthUnit::Index, 0.0, 0.0}; /* a scale of 0: that of the unit as dffdepth writes it */
    double near = 0.0;                            /* dioptres; near <= far: unknown */
    double far = 0.0;

    bool knows_range() const { return near > far; }

    bool operator==(const DepthFacts &other) const;
};

/* Where in the sweep each depth pixel lies, linear in dioptres: 0 at its near end or before, 1 at its far end
 * or behind, NAN for no value. Plane numbers and stage positions are taken as even in dioptres. Millimetres
 * of an unknown sweep are taken as of one from half a metre to infinity. */
std::vector<float> sweep_positions(const DepthFacts &facts);

/* The place of a vergence in the sweep; empty if its range is not known. */
std::optional<double> sweep_position(const DepthFacts &facts, double dioptre);

} // namespace dff
