/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "focalstack/plane_warp.h"
#include "focalstack/warp_solver.h"

namespace dff {

/* Where the picture of one plane lies beside the picture of the middle plane. */
struct PlaneAlignment {
    PlaneWarp warp;       /* a point of the middle plane is found at warp(point) in this plane */
    bool trusted = false; /* whether matches that can be believed lead from here to the middle plane */
    bool blank = false;   /* not trusted because there is nothing in the plane that could be matched */
};

/* The plane that stays as it is, and that the others are brought onto. */
constexpr std::size_t middle_plane(std::size_t planes)
{
    return planes / 2;
}

/* Finds the shift, turn and zoom of each plane of a stack against its middle plane: what a hand's shake and
 * focus breathing did. Without a `model`, similarities, or homographies where these explain clearly more.
 *
 * The planes are two or more pictures of one size with 8 or 16 bits and 1, 3 or 4 channels (of which the last
 * is ignored). Whatever their size they are matched small first, where blur that differs does not matter,
 * then larger: planes 1, 2, 4, 8 apart. All warps are found together, so that no error adds up from plane to
 * plane. A plane is trusted if, on pictures of 160 pixels, four fifths of its corners lie within a pixel of
 * where the warp says, and most of them in each quarter. One that cannot be matched goes with its neighbours.
 * Never throws for what is in the pictures. */
std::vector<PlaneAlignment> align_stack(std::span<const cv::Mat> planes,
                                        std::optional<MotionModel> model = {});

} // namespace dff
