/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <span>
#include <vector>

#include "focalstack/plane_matcher.h"
#include "focalstack/plane_warp.h"

namespace dff {

/* What may lie between two planes. */
enum class MotionModel { Similarity, Homography };

/* Two planes of a stack and the points found in both. */
struct PlaneLink {
    std::size_t from;
    std::size_t to;
    PlaneMatch match; /* in pixels of the picture */
    double pixel;     /* how large a pixel was of the size matched at, in pixels of the picture */
};

/* The warps A_z that bring every plane onto plane `reference`: of all warps of the model those for which
 * sum rho(|A_from p - A_to q|) over all matched points p, q is least, with Cauchy's rho against what strays.
 * Each link counts by how well its own points agree, so that links of several sizes can stand side by side:
 * planes that differ in blur agree where they are small, others where they are large.
 *
 * Found by Gauss-Newton from `warps`, which need to be right to a pixel or two of the smallest size. Planes
 * that no link reaches go with their neighbours. `size` is the picture's. */
std::vector<PlaneWarp> solve_warps(MotionModel model, std::vector<PlaneWarp> warps, std::size_t reference,
                                   std::span<const PlaneLink> links, cv::Size size);

/* How far the two ends of each match of a link come to lie from each other, in pixels that were matched. */
std::vector<double> misses(const PlaneLink &link, std::span<const PlaneWarp> warps);

/* The middle one, or 0 of nothing. */
double median(std::vector<double> values);

} // namespace dff
