/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "display_calibration.h"

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace dff {

namespace {

cv::FileStorage open(const std::string &path)
{
    cv::FileStorage file;
    try {
        file.open(path, cv::FileStorage::READ);
    } catch (const cv::Exception &error) {
        throw std::runtime_error("The display calibration \"" + path +
                                 "\" is neither JSON nor YAML: " + error.err);
    }
    if (!file.isOpened())
        throw std::runtime_error(
            "The display calibration \"" + path +
            "\" cannot be read; display-calibration must be the path of a JSON or YAML file");
    return file;
}

/* The number in a field, which may be that of a map's `value`. */
class Fields {
public:
    explicit Fields(const std::string &path) : path_(path), file_(open(path)) {}

    double number(const char *name) const
    {
        const cv::FileNode node = find(name);
        if (!node.isInt() && !node.isReal())
            throw std::runtime_error("The display calibration \"" + path_ + "\" has no number \"" + name +
                                     "\"");
        return node.real();
    }

    double positive(const char *name) const
    {
        const double value = number(name);
        if (!(value > 0.0) || !std::isfinite(value))
            throw std::runtime_error("\"" + std::string(name) + "\" in the display calibration \"" + path_ +
                                     "\" must be greater than 0");
        return value;
    }

    double number_or(const char *name, double otherwise) const
    {
        return find(name).empty() ? otherwise : number(name);
    }

    bool is_set(const char *name) const { return number_or(name, 0.0) != 0.0; }

private:
    cv::FileNode find(const char *name) const
    {
        const cv::FileNode node = file_[name];
        return node.isMap() ? node["value"] : node;
    }

    std::string path_;
    cv::FileStorage file_;
};

} // namespace

DisplayCalibration DisplayCalibration::load(const std::string &path)
{
    const Fields fields(path);
    const double width = fields.positive("screenW"), height = fields.positive("screenH");
    const double slope = fields.number("slope");
    if (slope == 0.0 || width > 32768.0 || height > 32768.0)
        throw std::runtime_error(
            "The display calibration \"" + path +
            "\" must have a slope other than 0 and a screen of at most 32768 pixels a side");

    DisplayCalibration calibration{};
    calibration.panel = {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
    calibration.view_cone = fields.number_or("viewCone", 0.0) * std::numbers::pi / 180.0;
    LenticularSheet &sheet = calibration.sheet;
    sheet.flip_x = fields.is_set("flipImageX");
    sheet.flip_y = fields.is_set("flipImageY");
    sheet.flip_subpixels = fields.is_set("flipSubp");
    sheet.invert_view = fields.is_set("invView");
    sheet.center = fields.number("center");
    sheet.pitch =
        fields.positive("pitch") * width / fields.positive("DPI") * std::cos(std::atan(1.0 / slope));
    sheet.tilt = height / (width * slope) * (sheet.flip_x ? -1.0 : 1.0);
    return calibration;
}

} // namespace dff
