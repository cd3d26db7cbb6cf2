/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/camera_calibration.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace dff {

namespace {

class FileReader {
public:
    explicit FileReader(const std::string &file) : file_(file)
    {
        try {
            storage_.open(file, cv::FileStorage::READ);
        } catch (const cv::Exception &error) {
            fail(error.err);
        }
        if (!storage_.isOpened())
            fail("it cannot be opened");
    }

    cv::Mat1d matrix(const char *name) const
    {
        cv::Mat values;
        try {
            storage_[name] >> values;
        } catch (const cv::Exception &error) {
            fail(error.err);
        }
        if (values.empty())
            fail(std::string(name) + " is missing");
        return values;
    }

    unsigned size(const char *name) const
    {
        const cv::FileNode node = storage_[name];
        if (!node.isInt() || static_cast<int>(node) <= 0)
            fail(std::string(name) + " is missing");
        return static_cast<unsigned>(static_cast<int>(node));
    }

    [[noreturn]] void fail(const std::string &what) const
    {
        throw std::runtime_error("The calibration " + file_ + " cannot be used: " + what);
    }

private:
    std::string file_;
    cv::FileStorage storage_;
};

} // namespace

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
    const FileReader reader(file);
    const cv::Mat1d camera = reader.matrix("camera_matrix");
    const cv::Mat1d distortion = reader.matrix("distortion_coefficients");
    if (camera.rows != 3 || camera.cols != 3)
        reader.fail("camera_matrix is not 3 x 3");

    CameraCalibration calibration;
    calibration.width = reader.size("image_width");
    calibration.height = reader.size("image_height");
    calibration.fx = camera(0, 0);
    calibration.fy = camera(1, 1);
    calibration.cx = camera(0, 2);
    calibration.cy = camera(1, 2);
    if (!(calibration.fx > 0.0) || !(calibration.fy > 0.0))
        reader.fail("the focal lengths in camera_matrix are not positive");
    if (distortion.total() > calibration.distortion.size() &&
        std::any_of(distortion.begin() + calibration.distortion.size(), distortion.end(),
                    [](double value) { return value != 0.0; }))
        reader.fail(
            "only the distortion coefficients k1, k2, p1, p2, k3 are known here; calibrate with those");
    std::copy_n(distortion.begin(), std::min(distortion.total(), calibration.distortion.size()),
                calibration.distortion.begin());
    return calibration;
}

} // namespace dff
