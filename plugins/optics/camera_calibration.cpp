/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/camera_calibration.h"

#include "optics/settings_file.h"

#include <algorithm>

namespace dff {

CameraCalibration CameraCalibration::scaled_to(unsigned new_width, unsigned new_height) const
{
    const double x = static_cast<double>(new_width) / width;
    const double y = static_cast<double>(new_height) / height;
    CameraCalibration scaled = *this;
    scaled.width = new_width;
    scaled.height = new_height;
    scaled.fx = fx * x;
    scaled.fy = fy * y;
    scaled.cx = (cx + 0.5) * x - 0.5;
    scaled.cy = (cy + 0.5) * y - 0.5;
    return scaled;
}

CameraCalibration read_camera_calibration(const std::string &file)
{
    constexpr unsigned largest_side = 1 << 16;
    constexpr Range pixels{-1e6, 1e6};
    constexpr Range focal_length{1e-3, 1e9};
    const FileEntries entries("The camera calibration", file);
    const FileEntries::Matrix camera = entries.matrix("camera_matrix", 3, 3);
    const FileEntries::Matrix distortion = entries.matrix("distortion_coefficients", 14, 14);
    if (camera.values.size() != 9)
        entries.fail("camera_matrix is not 3 x 3");

    CameraCalibration calibration;
    calibration.width = entries.whole_number("image_width", 1, largest_side);
    calibration.height = entries.whole_number("image_height", 1, largest_side);
    calibration.fx = entries.checked(camera.values[0], "camera_matrix[0][0]", focal_length);
    calibration.fy = entries.checked(camera.values[4], "camera_matrix[1][1]", focal_length);
    calibration.cx = entries.checked(camera.values[2], "camera_matrix[0][2]", pixels);
    calibration.cy = entries.checked(camera.values[5], "camera_matrix[1][2]", pixels);
    const auto known = std::min(distortion.values.size(), calibration.distortion.size());
    const auto unknown = distortion.values.begin() + static_cast<std::ptrdiff_t>(known);
    if (std::any_of(unknown, distortion.values.end(), [](double value) { return value != 0.0; }))
        entries.fail(
            "only the distortion coefficients k1, k2, p1, p2, k3 are known here; calibrate with those");
    std::copy(distortion.values.begin(), unknown, calibration.distortion.begin());
    return calibration;
}

} // namespace dff
