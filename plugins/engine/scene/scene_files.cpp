/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/scene_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

namespace dff {

namespace {

constexpr float unknown = std::numeric_limits<float>::infinity();

/* Percentile by linear interpolation between the sorted values. */
float percentile(const std::vector<float> &sorted, double percent)
{
    const double position = percent / 100.0 * static_cast<double>(sorted.size() - 1);
    const auto k = static_cast<size_t>(position);
    const float next = sorted[std::min(k + 1, sorted.size() - 1)];
    return static_cast<float>(std::lerp(sorted[k], next, position - static_cast<double>(k)));
}

/* Lowers `result` to the last known value before each pixel of a row, walking in one direction. */
template <typename Column>
void carry_known(const cv::Mat1f &values, cv::Mat1f &result, int y, int columns, Column column)
{
    float last = unknown;
    for (int i = 0; i < columns; i++) {
        const int x = column(i);
        if (values(y, x) != unknown)
            last = values(y, x);
        result(y, x) = std::min(result(y, x), last);
    }
}

/* The smaller (farther) of the nearest known values to the left and to the right. */
cv::Mat1f fill_rows(const cv::Mat1f &values)
{
    cv::Mat1f result(values.size(), unknown);
    for (int y = 0; y < values.rows; y++) {
        carry_known(values, result, y, values.cols, [](int i) { return i; });
        carry_known(values, result, y, values.cols, [&](int i) { return values.cols - 1 - i; });
    }
    values.copyTo(result, values != unknown);
    return result;
}

cv::Mat1f fill_unknown(const cv::Mat1f &disparity)
{
    cv::Mat1f values = disparity.clone();
    values.setTo(unknown, disparity <= 0.0F);
    values = fill_rows(values);
    return fill_rows(values.t()).t();
}

std::vector<float> sorted_known(const cv::Mat1f &disparity)
{
    std::vector<float> values;
    values.reserve(disparity.total());
    std::copy_if(disparity.begin(), disparity.end(), std::back_inserter(values),
                 [](float d) { return d > 0.0F; });
    std::sort(values.begin(), values.end());
    return values;
}

/* Empty if it cannot be read. A pipe is not opened: until somebody writes into it nothing would come back. */
cv::Mat read_picture(const std::string &path, cv::ImreadModes mode)
{
    std::error_code error;
    return std::filesystem::is_regular_file(path, error) ? cv::imread(path, mode) : cv::Mat();
}

cv::Mat1f read_disparity(const std::string &path)
{
    const cv::Mat map = read_picture(path, cv::IMREAD_UNCHANGED);
    if (map.empty())
        throw std::runtime_error("the depth map \"" + path +
                                 "\" cannot be read; depth-map must be the path of a PNG or TIFF file");
    if (map.channels() != 1 || (map.depth() != CV_8U && map.depth() != CV_16U))
        throw std::runtime_error("the depth map \"" + path +
                                 "\" must have one channel of 8 or 16 bits (disparity, larger is nearer)");
    cv::Mat1f disparity;
    map.convertTo(disparity, CV_32F);
    return disparity;
}

cv::Mat3b read_image(const std::string &path)
{
    const cv::Mat3b image = read_picture(path, cv::IMREAD_COLOR);
    if (image.empty())
        throw std::runtime_error("the image \"" + path +
                                 "\" cannot be read; image must be the path of a PNG, JPEG or TIFF file");
    cv::Mat3b color;
    cv::cvtColor(image, color, cv::COLOR_BGR2RGB);
    return color;
}

std::string text(cv::Size size)
{
    return std::to_string(size.width) + "x" + std::to_string(size.height);
}

} // namespace

Scene load_scene(const std::string &image_path, const std::string &depth_map_path)
{
    Scene scene;
    scene.color = read_image(image_path);
    const cv::Mat1f disparity = read_disparity(depth_map_path);
    if (disparity.size() != scene.size())
        throw std::runtime_error("the depth map is " + text(disparity.size()) + " but the image is " +
                                 text(scene.size()) + "; both must have the same size");

    const std::vector<float> values = sorted_known(disparity);
    const float far = values.empty() ? 0.0F : percentile(values, 0.2);
    const float near = values.empty() ? 0.0F : percentile(values, 99.8);
    if (near <= far)
        throw std::runtime_error("the depth map \"" + depth_map_path +
                                 "\" is flat; it must hold at least two disparities");

    scene.depth = fill_unknown(disparity);
    for (float &value : scene.depth)
        value = (near - std::clamp(value, far, near)) / (near - far);
    scene.known = disparity > 0.0F;
    return scene;
}

cv::Size image_size(const std::string &image_path)
{
    return read_image(image_path).size();
}

Scene resize_scene(const Scene &scene, cv::Size size)
{
    if (size == scene.size())
        return scene;
    Scene resized;
    const bool smaller = size.area() < scene.size().area();
    cv::resize(scene.color, resized.color, size, 0, 0, smaller ? cv::INTER_AREA : cv::INTER_CUBIC);
    cv::resize(scene.depth, resized.depth, size, 0, 0, cv::INTER_NEAREST);
    if (!scene.known.empty())
        cv::resize(scene.known, resized.known, size, 0, 0, cv::INTER_NEAREST);
    return resized;
}

} // namespace dff
