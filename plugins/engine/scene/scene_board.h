/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/scene.h"
#include "optics/camera_calibration.h"
#include "optics/sweep_plan.h"

#include <optional>
#include <string>

namespace dff {

/* Where the middle of the board is, and how it is turned, seen from the camera: x right, y down, z away. */
struct BoardPose {
    cv::Vec3d metres{0.0, 0.0, 0.5};
    cv::Vec3d degrees; /* about x, then y, then z */

    /* Of "X,Y,Z" or "X,Y,Z,RX,RY,RZ"; nothing if it is none or lies behind the camera. */
    static std::optional<BoardPose> parse(const std::string &text);
};

/* A chessboard with a white border as wide as a square. */
struct BoardSheet {
    int columns = 10; /* squares */
    int rows = 7;
    double square_mm = 25.0;

    /* Of "COLUMNSxROWSxMILLIMETRES", as 10x7x25; nothing if it is none. */
    static std::optional<BoardSheet> parse(const std::string &text);
};

/* The board before a gray wall at the far end of the sweep, as `camera` projects it on pictures of its size.
 */
Scene make_board(const BoardSheet &sheet, const BoardPose &pose, const CameraCalibration &camera,
                 const SweepPlan &plan);

} // namespace dff
