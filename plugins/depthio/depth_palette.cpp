/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/depth_palette.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace dff {

namespace {

constexpr int edge_steps = 255;
constexpr int hue_edges = 5;
constexpr int hue_steps = edge_steps * hue_edges;
constexpr int known_brightness = 128;
constexpr double darkest_gray = 40.0;

Colour hue_colour(double position)
{
    const int step = static_cast<int>(std::lround(position * hue_steps));
    const int edge = std::min(step / edge_steps, hue_edges - 1);
    const auto up = static_cast<uint8_t>(step - edge * edge_steps);
    const auto down = static_cast<uint8_t>(edge_steps - up);
    switch (edge) {
    case 0:
        return {255, up, 0};
    case 1:
        return {down, 255, 0};
    case 2:
        return {0, 255, up};
    case 3:
        return {0, down, 255};
    default:
        return {up, 0, 255};
    }
}

/* OpenCV's map from cold to warm. */
std::array<Colour, 256> opencv_map(int map)
{
    cv::Mat ramp(1, 256, CV_8UC1);
    for (int k = 0; k < 256; k++)
        ramp.at<uint8_t>(k) = static_cast<uint8_t>(k);
    cv::Mat bgr;
    cv::applyColorMap(ramp, bgr, map);
    std::array<Colour, 256> colours{};
    for (int k = 0; k < 256; k++) {
        const auto colour = bgr.at<cv::Vec3b>(k);
        colours[static_cast<size_t>(k)] = {colour[2], colour[1], colour[0]};
    }
    return colours;
}

std::array<Colour, 256> gray_map()
{
    std::array<Colour, 256> colours{};
    for (size_t k = 0; k < colours.size(); k++) {
        const auto gray =
            static_cast<uint8_t>(std::lround(std::lerp(darkest_gray, 255.0, static_cast<double>(k) / 255.0)));
        colours[k] = {gray, gray, gray};
    }
    return colours;
}

} // namespace

PaletteColours::PaletteColours(DepthPalette palette) : palette_(palette)
{
    if (palette == DepthPalette::Turbo)
        map_ = opencv_map(cv::COLORMAP_TURBO);
    else if (palette == DepthPalette::Jet)
        map_ = opencv_map(cv::COLORMAP_JET);
    else if (palette == DepthPalette::Gray)
        map_ = gray_map();
}

Colour PaletteColours::at(double position) const
{
    position = std::clamp(position, 0.0, 1.0);
    if (palette_ == DepthPalette::Hue)
        return hue_colour(position);
    return map_[static_cast<size_t>(std::lround(255.0 * (1.0 - position)))];
}

std::optional<double> hue_position(Colour colour)
{
    const int red = colour[0], green = colour[1], blue = colour[2];
    const int most = std::max({red, green, blue});
    const int chroma = most - std::min({red, green, blue});
    if (most < known_brightness || chroma == 0)
        return std::nullopt;

    const auto along = [&](int difference) { return static_cast<double>(difference) / chroma; };
    double edges = 0.0;
    if (most == red)
        edges = along(green - blue); /* below 0 between red and magenta, in the gap */
    else if (most == green)
        edges = 2.0 + along(blue - red);
    else
        edges = 4.0 + along(red - green);
    if (edges < -0.5)
        edges = hue_edges;
    return std::clamp(edges / hue_edges, 0.0, 1.0);
}

} // namespace dff
