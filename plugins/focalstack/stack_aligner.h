/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "focalstack/plane_warp.h"

namespace dff {

/* Where the picture of one plane lies beside the picture of the middle plane. */
struct PlaneAlignment {
    PlaneWarp warp;       /* a point of the middle plane is found at warp(point) in this plane */
    bool trusted = false; /* whether matches that can be believed lead from here to the middle plane */
};

/* The plane that stays as it is, and that the others are brought onto. */
constexpr std::size_t middle_plane(std::size_t planes)
{
    return planes / 2;
}

/* Finds the shift, turn and zoom of each plane of a stack against its middle plane: what a hand's shake and
 * focus breathing did.
 *
 * The planes are two or more pictures of one size with 8 or 16 bits and 1, 3 or 4 channels (of which the last
 * is ignored). Planes 1, 2, 4, 8 apart are matched, and all warps are found together, so that no error adds
 * up from plane to plane. A plane that cannot be matched goes with its neighbours. Never throws for what
 * is in the pictures. */
std::vector<PlaneAlignment> align_stack(std::span<const cv::Mat> planes);

/* Writes into `aligned` what `component`, a picture or its chroma with one sample for each `step` x `step`
 * pixels, would show without the warp. Lanczos' kernel, since a softer one takes noise and detail from some
 * planes and not from others; reflected at the border. Both have the same size and type, but not memory. */
void undo_warp(const cv::Mat &component, cv::Mat aligned, const PlaneWarp &warp, int step = 1);

} // namespace dff
