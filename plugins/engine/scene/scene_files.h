/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/scene.h"

#include <string>

namespace dff {

/* A scene from a photograph and its disparity map of the same size, 8 or 16 bits: larger is nearer, 0 is
 * unknown and is filled with the farther of the nearest known values to the left and right (else above and
 * below). The 0.2 and 99.8 percentiles of the known disparities become the two ends of the sweep.
 * Throws std::runtime_error, with a message for the user, if a file cannot be read or does not fit. */
Scene load_scene(const std::string &image_path, const std::string &depth_map_path);

/* Size of an image file; throws like load_scene(). */
cv::Size image_size(const std::string &image_path);

/* The scene at another size: the picture is filtered, the depth map takes the nearest pixel. */
Scene resize_scene(const Scene &scene, cv::Size size);

} // namespace dff
