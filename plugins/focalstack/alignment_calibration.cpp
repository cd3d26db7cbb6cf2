/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/alignment_calibration.h"

#include <numbers>
#include <stdexcept>

namespace dff {

namespace {

[[noreturn]] void fail(const std::string &file, const std::string &what)
{
    throw std::runtime_error("The calibration " + file + " cannot be used: " + what);
}

double number(const std::string &file, const cv::FileNode &parent, const char *name)
{
    const cv::FileNode node = parent[name];
    if (!node.isReal() && !node.isInt())
        fail(file, std::string(name) + " is missing");
    return static_cast<double>(node);
}

} // namespace

AlignmentCalibration AlignmentCalibration::load(const std::string &file)
{
    AlignmentCalibration calibration;
    calibration.file_ = file;
    try {
        const cv::FileStorage storage(file, cv::FileStorage::READ);
        if (!storage.isOpened())
            fail(file, "it cannot be opened");
        const cv::FileNode root = storage.root();
        calibration.size_ = {static_cast<int>(number(file, root, "image_width")),
                             static_cast<int>(number(file, root, "image_height"))};
        for (const cv::FileNode &plane : root["planes"]) {
            const double scale = number(file, plane, "scale");
            const double angle = number(file, plane, "rotation") * std::numbers::pi / 180.0;
            calibration.warps_.push_back({scale * std::cos(angle), scale * std::sin(angle),
                                          number(file, plane, "dx"), number(file, plane, "dy")});
            if (!(scale > 0.0))
                fail(file, "scale is not positive");
        }
    } catch (const cv::Exception &error) {
        fail(file, error.err);
    }
    if (calibration.size_.empty() || calibration.warps_.empty())
        fail(file, "it has no planes or no image size");
    return calibration;
}

std::vector<PlaneAlignment> AlignmentCalibration::alignments(cv::Size size, unsigned planes) const
{
    if (planes != warps_.size())
        fail(file_, "it has " + std::to_string(warps_.size()) + " planes and the stack has " +
                        std::to_string(planes));
    std::vector<PlaneAlignment> result;
    for (PlaneWarp warp : warps_) {
        warp.dx *= static_cast<double>(size.width) / size_.width;
        warp.dy *= static_cast<double>(size.height) / size_.height;
        result.push_back({warp, true});
    }
    return result;
}

} // namespace dff
