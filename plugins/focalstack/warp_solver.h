/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <span>
#include <vector>

#include "focalstack/plane_matcher.h"
#include "focalstack/plane_warp.h"

namespace dff {

/* Two planes of a stack and the points found in both. */
struct PlaneLink {
    std::size_t from;
    std::size_t to;
    PlaneMatch match;
};

/* The warps A_z that bring every plane onto plane `reference`: of all similarities those for which
 * sum rho(|A_from p - A_to q|) over all matched points p, q is least, with Cauchy's rho against what strays.
 * A similarity is linear in its four numbers, so this is a linear least-squares problem, weighted anew a few
 * times. Planes that no link reaches go with their neighbours. */
std::vector<PlaneWarp> solve_warps(std::size_t planes, std::size_t reference,
                                   std::span<const PlaneLink> links, cv::Size size);

} // namespace dff
