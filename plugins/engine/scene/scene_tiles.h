/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/scene.h"

#include <stop_token>
#include <vector>

namespace dff {

/* The part of one depth layer that can be seen in a tile, blurred or not. */
struct LayerPatch {
    int layer;       /* a smaller number is nearer */
    cv::Rect where;  /* in the picture */
    cv::Mat3b color; /* continued behind nearer layers with the nearest visible colour */
    cv::Mat1b reach; /* the layer covers a pixel once its blur reaches this far; 255: never */
};

/* A rectangle of the picture with the layers that contribute to it, far to near. */
struct SceneTile {
    cv::Rect where;
    std::vector<LayerPatch> patches;
};

/* Cuts the picture into tiles and each tile into layers of equal depth. `layers` holds the layer of each
 * pixel, `max_reach` is the largest blur radius in whole pixels. Runs on all cores; gives an empty vector if
 * `stop` was requested. */
std::vector<SceneTile> cut_scene(const cv::Mat3b &color, const cv::Mat1i &layers, int max_reach,
                                 const std::stop_token &stop);

} // namespace dff
