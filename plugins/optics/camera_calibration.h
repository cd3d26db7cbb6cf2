/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <array>
#include <string>

namespace dff {

/* How a camera projects, as OpenCV's calibrateCamera() says it: pixel = f * (x', y') + c with the distorted
 * x' = X / Z, y' = Y / Z; X points right, Y down, Z away from the camera; pixel centres lie at whole numbers.
 */
struct CameraCalibration {
    unsigned width = 0; /* of the calibrated pictures */
    unsigned height = 0;
    double fx = 0.0; /* pixels */
    double fy = 0.0;
    double cx = 0.0;
    double cy = 0.0;
    std::array<double, 5> distortion{}; /* k1, k2, p1, p2, k3 */

    /* The same camera with its pictures scaled. */
    CameraCalibration scaled_to(unsigned new_width, unsigned new_height) const;

    bool operator==(const CameraCalibration &) const = default;
};

/* Reads a file of OpenCV's calibration sample (optics/settings_file.h: camera_matrix,
 * distortion_coefficients, image_width, image_height). Throws std::runtime_error with a user's text that
 * names the file and what is wrong with it. */
CameraCalibration read_camera_calibration(const std::string &file);

} // namespace dff
