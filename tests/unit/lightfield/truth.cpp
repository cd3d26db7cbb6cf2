/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "truth.h"

#include "engine/light_field_geometry.h"
#include "engine/light_field_renderer.h"
#include "optics/depth_scale.h"

#include <cmath>

namespace dff {

Truth::Truth(cv::Size size, const LightFieldParameters &parameters)
    : middle(make_shapes(size, 1)), parameters(parameters)
{
    for (unsigned view = 0; view < parameters.columns; view++) {
        slopes.push_back(view_slope(view, parameters.columns, parameters.view_cone));
        const double eye = slopes.back() * parameters.depth_gain * size.width / shapes_focal_length(size);
        views.push_back(make_shapes(size, 1, {}, {{eye, 0.0}, parameters.zero_parallax}));
    }
}

cv::Mat1b Truth::mutually_visible(unsigned view) const
{
    const cv::Mat1f &seen = views[view].depth;
    cv::Mat1b mask(seen.size(), uchar{0});
    for (int y = 0; y < seen.rows; y++)
        for (int x = 0; x < seen.cols; x++) {
            const double height = parameters.depth_gain * seen.cols * (parameters.zero_parallax - seen(y, x));
            const double there = x + slopes[view] * height;
            const auto left = static_cast<int>(std::floor(there));
            if (left < 0 || left + 1 >= seen.cols)
                continue;
            const bool same = std::abs(middle.depth(y, left) - seen(y, x)) < 0.01F &&
                              std::abs(middle.depth(y, left + 1) - seen(y, x)) < 0.01F;
            mask(y, x) = same ? 255 : 0;
        }
    return mask;
}

cv::Mat1w depth_map(const Scene &scene)
{
    cv::Mat1w map(scene.size());
    for (int y = 0; y < map.rows; y++)
        for (int x = 0; x < map.cols; x++)
            map(y, x) =
                static_cast<uint16_t>(1 + std::lround((DepthScale::max_pixel - 1) * scene.depth(y, x)));
    return map;
}

cv::Mat3b render(const cv::Mat3b &color, const cv::Mat1w &depth, const LightFieldParameters &parameters,
                 cv::Size output)
{
    const auto size_of = [](cv::Size size) {
        return PictureSize{static_cast<uint32_t>(size.width), static_cast<uint32_t>(size.height)};
    };
    const LightFieldShape shape{PixelFormat::Rgb, size_of(color.size()), size_of(output)};
    LightFieldRenderer renderer(Device::open(""), shape, parameters);
    cv::Mat3b picture(output);
    const auto bytes = [](const cv::Mat &mat) {
        return std::as_writable_bytes(std::span(mat.data, mat.total() * mat.elemSize()));
    };
    renderer.render({bytes(color), color.step}, {bytes(depth), depth.step}, bytes(picture), picture.step);
    return picture;
}

std::vector<cv::Mat3b> render_views(const cv::Mat3b &color, const cv::Mat1w &depth,
                                    const LightFieldParameters &parameters)
{
    const int columns = static_cast<int>(parameters.columns);
    const cv::Mat3b row = render(color, depth, parameters, {columns * color.cols, color.rows});
    std::vector<cv::Mat3b> views;
    for (int view = 0; view < columns; view++)
        views.push_back(row(cv::Rect(view * color.cols, 0, color.cols, color.rows)).clone());
    return views;
}

double psnr(const cv::Mat3b &found, const cv::Mat3b &expected, const cv::Mat1b &mask)
{
    const double squares = std::pow(cv::norm(found, expected, cv::NORM_L2, mask), 2.0);
    const double samples = 3.0 * (mask.empty() ? static_cast<double>(found.total()) : cv::countNonZero(mask));
    return 10.0 * std::log10(255.0 * 255.0 * samples / squares);
}

} // namespace dff
