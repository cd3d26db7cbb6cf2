/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/camera_calibration.h"

#include <fstream>
#include <gtest/gtest.h>
#include <stdexcept>
#include <unistd.h>

using namespace dff;

namespace {

const std::string camera_matrix = "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                                  "   data: [ 800., 0., 319.5, 0., 810., 239.5, 0., 0., 1. ]\n";
const std::string size = "image_width: 640\nimage_height: 480\n";

std::string distortion(const std::string &count, const std::string &values)
{
    return "distortion_coefficients: !!opencv-matrix\n   rows: " + count +
           "\n   cols: 1\n   dt: d\n   data: [ " + values + " ]\n";
}

std::string with(std::string from, const std::string &part, const std::string &other)
{
    return from.replace(from.find(part), part.size(), other);
}

class CalibrationFile {
public:
    explicit CalibrationFile(const std::string &text)
        : name(testing::TempDir() + "calibration" + std::to_string(getpid()) + ".yml")
    {
        std::ofstream(name) << "%YAML:1.0\n---\n" << text;
    }
    ~CalibrationFile() { unlink(name.c_str()); }

    const std::string name;
};

void expect_refused(const std::string &text, const std::string &reason)
{
    const CalibrationFile file(text);
    try {
        read_camera_calibration(file.name);
        ADD_FAILURE() << "not refused: " << text;
    } catch (const std::runtime_error &error) {
        EXPECT_NE(std::string(error.what()).find(file.name), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
}

} // namespace

TEST(CameraCalibration, opencv_file_is_read)
{
    const CalibrationFile file(size + camera_matrix + distortion("5", "0.1, -0.2, 0.001, 0.002, 0.3"));
    const CameraCalibration camera = read_camera_calibration(file.name);
    EXPECT_EQ(camera.width, 640u);
    EXPECT_EQ(camera.height, 480u);
    EXPECT_EQ(camera.fx, 800.0);
    EXPECT_EQ(camera.fy, 810.0);
    EXPECT_EQ(camera.cx, 319.5);
    EXPECT_EQ(camera.cy, 239.5);
    EXPECT_EQ(camera.distortion, (std::array{0.1, -0.2, 0.001, 0.002, 0.3}));
}

TEST(CameraCalibration, scaling_keeps_the_middle_in_the_middle)
{
    const CalibrationFile file(size + camera_matrix + distortion("4", "0, 0, 0, 0"));
    const CameraCalibration half = read_camera_calibration(file.name).scaled_to(320, 240);
    EXPECT_EQ(half.fx, 400.0);
    EXPECT_EQ(half.cx, 159.5);
    EXPECT_EQ(half.cy, 119.5);
}

TEST(CameraCalibration, what_is_wrong_with_a_file_is_told)
{
    expect_refused(size + distortion("4", "0, 0, 0, 0"), "camera_matrix is missing");
    expect_refused(size + camera_matrix, "distortion_coefficients is missing");
    expect_refused(camera_matrix + distortion("4", "0, 0, 0, 0"), "image_width is missing");
    expect_refused(size + camera_matrix + distortion("8", "0, 0, 0, 0, 0, 1, 2, 3"), "k1, k2, p1, p2, k3");
    expect_refused(size + with(camera_matrix, "dt: d", "dt: \"2f\"") + distortion("4", "0, 0, 0, 0"),
                   "camera_matrix.dt is \"2f\"");
    expect_refused(size + with(camera_matrix, "cols: 3", "cols: 2") + distortion("4", "0, 0, 0, 0"),
                   "camera_matrix.data must be a list of 6 numbers");
    expect_refused(size + with(camera_matrix, "800.", "-800.") + distortion("4", "0, 0, 0, 0"),
                   "camera_matrix[0][0] is -800 and must be 0.001 to");
    expect_refused(size + with(camera_matrix, "239.5", "1e300") + distortion("4", "0, 0, 0, 0"),
                   "camera_matrix[1][2] is 1e+300 and must be");
    expect_refused(size + camera_matrix + distortion("4", "0, 0, 0, .inf"), "must be finite");
    expect_refused(with(size, "640", "-640") + camera_matrix + distortion("4", "0, 0, 0, 0"),
                   "image_width is -640 and must be 1 to 65536");
    expect_refused("camera_matrix: [", "");
    EXPECT_THROW(read_camera_calibration("/nonexistent.yml"), std::runtime_error);
}
