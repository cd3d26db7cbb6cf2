/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <span>
#include <vector>

#include "focalstack/warp_solver.h"

namespace dff {

/* Which planes can be reached from the middle over links whose points lie where the warps say: four fifths of
 * all, and most of those in each quarter of the picture. What moves by itself, and corners that wander with
 * the blur of an edge, are the rest. */
std::vector<bool> trusted_planes(std::size_t planes, std::size_t middle, std::span<const PlaneLink> links,
                                 std::span<const PlaneWarp> warps);

/* How far the points of the links lie apart, in pixels that were matched: the mean over the links of the
 * middle miss of each. */
double typical_miss(std::span<const PlaneLink> links, std::span<const PlaneWarp> warps);

} // namespace dff
