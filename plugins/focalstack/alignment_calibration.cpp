/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/alignment_calibration.h"

#include "optics/settings_file.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace dff {

namespace {

constexpr unsigned largest_side = 1 << 16;
constexpr unsigned most_planes = 64;
constexpr Range pixels{-65536.0, 65536.0};
constexpr Range zoom{0.1, 10.0};
constexpr Range degrees{-360.0, 360.0};

/* A homography may not turn the picture over, nor take its centre to infinity. */
PlaneWarp homography_of(const FileEntries &plane)
{
    const std::vector<double> numbers = plane.numbers("matrix", 9, 9, pixels);
    const cv::Matx33d matrix(numbers.data());
    if (matrix(2, 2) == 0.0 || !(cv::determinant(matrix * (1.0 / matrix(2, 2))) > 0.0))
        plane.fail("a matrix cannot be undone");
    return PlaneWarp(matrix);
}

PlaneWarp warp_of(const FileEntries &plane)
{
    if (plane.has("matrix"))
        return homography_of(plane);
    const double scale = plane.number("scale", zoom);
    const double angle = plane.number("rotation", degrees) * std::numbers::pi / 180.0;
    return {scale * std::cos(angle), scale * std::sin(angle), plane.number("dx", pixels),
            plane.number("dy", pixels)};
}

} // namespace

AlignmentCalibration AlignmentCalibration::load(const std::string &file)
{
    const FileEntries entries("The alignment calibration", file);
    AlignmentCalibration calibration;
    calibration.file_ = file;
    calibration.size_ = {static_cast<int>(entries.whole_number("image_width", 1, largest_side)),
                         static_cast<int>(entries.whole_number("image_height", 1, largest_side))};
    for (const FileEntries &plane : entries.list("planes", most_planes))
        calibration.warps_.push_back(warp_of(plane));
    return calibration;
}

std::vector<PlaneAlignment> AlignmentCalibration::alignments(cv::Size size, unsigned planes) const
{
    if (planes != warps_.size())
        throw std::runtime_error("The alignment calibration " + file_ + " cannot be used: it has " +
                                 std::to_string(warps_.size()) + " planes and the stack has " +
                                 std::to_string(planes));
    std::vector<PlaneAlignment> result;
    const double x = static_cast<double>(size.width) / size_.width;
    const double y = static_cast<double>(size.height) / size_.height;
    for (const PlaneWarp &warp : warps_)
        result.push_back({warp.in_picture_larger_by(x, y), true});
    return result;
}

} // namespace dff
