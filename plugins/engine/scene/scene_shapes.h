/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <stop_token>

namespace dff {

/* Where the camera stands: beside its place, its sensor shifted such that what lies `zero_parallax` deep in
 * the sweep (0 near, 1 far, linear in dioptres; below 1) keeps its place in the picture. */
struct Viewpoint {
    cv::Vec2d offset{0.0, 0.0}; /* right and down, in units of the distance of the sweep's near end */
    double zero_parallax = 0.5;
};

/* Balls, blocks and pillars, textured and plain, on a textured ground that slants from the near end of the
 * sweep away to a textured wall near its far end. `seed` changes the textures, not the arrangement. Runs on
 * all cores; unfinished where `stop` was requested. */
Scene make_shapes(cv::Size size, uint64_t seed, const std::stop_token &stop = {}, const Viewpoint &from = {});

/* Focal length in pixels of the camera that sees them. */
double shapes_focal_length(cv::Size size);

} // namespace dff
