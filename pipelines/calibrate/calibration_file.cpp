/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "calibration_file.h"

#include "optics/focus_calibration.h"
#include "optics/settings_file.h"
#include "whole_file.h"

#include <numbers>
#include <opencv2/core/persistence.hpp>

namespace dff {

namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

void write_camera(cv::FileStorage &file, const CameraCalibration &camera)
{
    file << "image_width" << static_cast<int>(camera.width) << "image_height"
         << static_cast<int>(camera.height);
    const cv::Mat1d matrix = (cv::Mat1d(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    file << "camera_matrix" << matrix << "distortion_coefficients"
         << cv::Mat1d(static_cast<int>(camera.distortion.size()), 1,
                      const_cast<double *>(camera.distortion.data()));
}

void write_planes(cv::FileStorage &file, const std::vector<PlaneSimilarity> &planes)
{
    file << "planes"
         << "[";
    for (const PlaneSimilarity &plane : planes)
        file << "{:"
             << "dx" << plane.dx << "dy" << plane.dy << "scale" << plane.scale() << "rotation"
             << std::atan2(plane.sine, plane.cosine) * degrees << "}";
    file << "]";
}

void write_focus(cv::FileStorage &file, const RigCalibration &calibration)
{
    const FocusSurface &focus = calibration.focus;
    file.writeComment(
        "dioptres in the picture's centre, a plane each; field is added at x, y and x^2 + y^2, in half "
        "diagonals from the centre");
    file << "focus"
         << "{"
         << "vergences" << focus.vergences << "field"
         << std::vector<double>(focus.field.begin(), focus.field.end()) << "deviations" << focus.deviations
         << "blur_step" << calibration.blur_step << "aperture_mm" << calibration.aperture_mm << "}";
}

void write_light(cv::FileStorage &file, const RigCalibration &calibration)
{
    if (!calibration.light.planes.empty()) {
        std::vector<double> gains, vignettings, deviations;
        for (const PlaneLight &plane : calibration.light.planes) {
            gains.push_back(plane.gain);
            vignettings.push_back(plane.vignetting);
            deviations.push_back(plane.deviation);
        }
        file.writeComment("a plane each shows light times gain (1 - vignetting r^2), r in half diagonals");
        file << "light"
             << "{"
             << "gain" << gains << "vignetting" << vignettings << "deviations" << deviations << "residual"
             << calibration.light.residual << "}";
    }
    if (calibration.noise.is_known) {
        file.writeComment("variance at the brightness I, DN^2: slope I + offset");
        file << "noise"
             << "{"
             << "slope" << calibration.noise.slope << "offset" << calibration.noise.offset << "}";
    }
    std::vector<int> numbers;
    for (const cv::Point &pixel : calibration.bad_pixels) {
        numbers.push_back(pixel.x);
        numbers.push_back(pixel.y);
    }
    if (!numbers.empty()) {
        file.writeComment("column and row of each");
        file << "bad_pixels" << numbers;
    }
}

void write_residuals(cv::FileStorage &file, const RigCalibration &calibration, const Board &board)
{
    file << "made_from"
         << "{"
         << "boards" << static_cast<int>(calibration.boards) << "columns" << board.columns << "rows"
         << board.rows << "square_mm" << board.square_mm << "reprojection_px" << calibration.reprojection_px
         << "focal_length_deviation" << calibration.focal_deviation << "plane_shift_px"
         << calibration.warps.residual_px << "vergence_planes"
         << calibration.focus.residual / calibration.focus.step() << "}";
    for (const std::string &weakness : calibration.weak)
        file.writeComment(weakness);
}

std::vector<PlaneSimilarity> read_planes(const std::string &path)
{
    constexpr Range pixels{-65536.0, 65536.0}, zoom{0.1, 10.0}, turn{-360.0, 360.0};
    constexpr std::size_t most_planes = 64;
    const FileEntries file("The calibration", path);
    std::vector<PlaneSimilarity> planes;
    for (const FileEntries &plane : file.list("planes", most_planes)) {
        const double scale = plane.number("scale", zoom), angle = plane.number("rotation", turn) / degrees;
        planes.push_back({scale * std::cos(angle), scale * std::sin(angle), plane.number("dx", pixels),
                          plane.number("dy", pixels)});
    }
    return planes;
}

} // namespace

void write_calibration(const std::string &path, const RigCalibration &calibration, const Board &board)
{
    cv::FileStorage storage(".yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    write_camera(storage, calibration.camera);
    write_planes(storage, calibration.warps.planes);
    write_focus(storage, calibration);
    write_light(storage, calibration);
    write_residuals(storage, calibration, board);
    write_whole_file("The file", path, storage.releaseAndGetString());
}

RigCalibration read_calibration(const std::string &path)
{
    RigCalibration calibration;
    calibration.camera = read_camera_calibration(path);
    const auto focus = read_focus_calibration(path);
    if (!focus)
        throw std::runtime_error("The calibration " + path + " has no focus: dff-calibrate did not write it");
    calibration.focus.vergences = focus->vergences;
    calibration.focus.field = focus->field;
    calibration.warps.planes = read_planes(path);
    if (calibration.warps.planes.size() != focus->vergences.size())
        throw std::runtime_error("The calibration " + path +
                                 " has another number of planes than of vergences");
    return calibration;
}

} // namespace dff
