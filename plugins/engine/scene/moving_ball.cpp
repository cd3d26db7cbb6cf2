/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/moving_ball.h"

#include "engine/scene/material.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace dff {

namespace {

constexpr double relative_radius = 0.09; /* of the shorter side */
constexpr double relative_height = 0.4;  /* of the path, from the top */
constexpr double finest_wave = 3.0;      /* of its texture, pixels */
constexpr int rim_samples = 4;           /* a pixel and axis */

/* Colour at a point of the unit disk, shaded like a ball under a lamp. */
Color look_at(const Material &material, double x, double y)
{
    const double z = -std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
    const cv::Vec3d normal(x, y, z);
    const double light = std::max(0.0, normal.dot({-0.4, -0.7, -0.6}));
    return material.color(normal) * (0.35 + 0.75 * light);
}

cv::Vec4f sample_pixel(const Material &material, double x, double y, double radius)
{
    const int samples = std::hypot(x, y) < radius - 1.0 ? 1 : rim_samples;
    cv::Vec4d sum;
    for (int j = 0; j < samples; j++)
        for (int i = 0; i < samples; i++) {
            const double u = (x + (i + 0.5) / samples - 0.5) / radius;
            const double v = (y + (j + 0.5) / samples - 0.5) / radius;
            if (u * u + v * v > 1.0)
                continue;
            const Color color = look_at(material, u, v);
            sum += cv::Vec4d(std::min(255.0, 255.0 * color[0]), std::min(255.0, 255.0 * color[1]),
                             std::min(255.0, 255.0 * color[2]), 1.0);
        }
    return sum / (samples * samples);
}

} // namespace

MovingBall::MovingBall(cv::Size picture, double speed, uint64_t seed)
    : picture_(picture), speed_(speed), radius_(relative_radius * std::min(picture.width, picture.height))
{
    const Material material{Pattern::Segments,
                            {0.95, 0.3, 0.5},
                            {0.98, 0.92, 0.4},
                            0.5,
                            0.0,
                            FractalNoise(seed, finest_wave / radius_, 0.85)};
    const int half = static_cast<int>(std::ceil(radius_)) + 1;
    sprite_.create(2 * half + 1, 2 * half + 1);
    for (int y = -half; y <= half; y++)
        for (int x = -half; x <= half; x++)
            sprite_(y + half, x + half) = sample_pixel(material, x, y, radius_);
}

cv::Point2d MovingBall::center(double time) const
{
    const double way = std::max(1.0, picture_.width - 2.0 * radius_);
    const double there_and_back = std::fmod(std::abs(speed_) * time, 2.0 * way);
    const double x = there_and_back < way ? there_and_back : 2.0 * way - there_and_back;
    return {radius_ + (speed_ < 0.0 ? way - x : x), relative_height * picture_.height};
}

cv::Mat4f MovingBall::draw(double time, const cv::Matx23d &warp, const cv::Rect &where) const
{
    /* Sprite to picture, then the picture's own warp, then to the part asked for. */
    const cv::Point middle(sprite_.cols / 2, sprite_.rows / 2);
    const cv::Point2d offset = center(time) - cv::Point2d(middle);
    const cv::Matx23d place(warp(0, 0), warp(0, 1),
                            warp(0, 0) * offset.x + warp(0, 1) * offset.y + warp(0, 2) - where.x, warp(1, 0),
                            warp(1, 1), warp(1, 0) * offset.x + warp(1, 1) * offset.y + warp(1, 2) - where.y);
    cv::Mat4f drawn;
    cv::warpAffine(sprite_, drawn, place, where.size(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
    return drawn;
}

} // namespace dff
