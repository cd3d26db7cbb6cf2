/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/moving_thing.h"

#include "engine/scene/material.h"
#include "engine/scene/seeds.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace dff {

namespace {

constexpr double relative_radius = 0.09; /* of the shorter side */
constexpr double finest_wave = 3.0;      /* of textures, pixels */
constexpr int rim_samples = 4;           /* a pixel and axis */
constexpr double far_over_near = 0.1;    /* of the sweep, dioptres: sizes go by it */

struct Look {
    double height;    /* of the path, from the top, in picture heights */
    double direction; /* to the right, or to the left */
    double nearest, farthest;
    double layer;
};

Look look_of(MovingKind kind)
{
    switch (kind) {
    case MovingKind::Crossing:
        return {0.45, -1.0, 0.3, 0.3, 0.3};
    case MovingKind::Turning:
        return {0.75, 1.0, 0.2, 0.2, 0.2};
    case MovingKind::Nearing:
        return {0.2, 1.0, 0.1, 0.6, 0.35};
    case MovingKind::Plain:
        return {0.6, 1.0, 0.15, 0.15, 0.15};
    default:
        return {0.4, 1.0, 0.15, 0.15, 0.15};
    }
}

Material material_of(MovingKind kind, uint64_t seed, double radius)
{
    const FractalNoise grain(seed, finest_wave / radius, 0.85);
    switch (kind) {
    case MovingKind::Plain:
        return {Pattern::Plain, {0.85, 0.6, 0.15}, {}, 1.0, 0.0, grain};
    case MovingKind::Turning:
        return {Pattern::Checks, {0.2, 0.5, 0.95}, {0.95, 0.9, 0.7}, 0.5, 0.0, grain};
    case MovingKind::Crossing:
        return {Pattern::Segments, {0.2, 0.8, 0.5}, {0.95, 0.95, 0.95}, 0.5, 0.0, grain};
    default:
        return {Pattern::Segments, {0.95, 0.3, 0.5}, {0.98, 0.92, 0.4}, 0.5, 0.0, grain};
    }
}

bool is_inside(MovingKind kind, double u, double v)
{
    return kind == MovingKind::Turning ? std::max(std::abs(u), std::abs(v)) <= 1.0 : u * u + v * v <= 1.0;
}

/* Colour at a point of the unit disk, shaded like a ball under a lamp; what is flat is lit evenly. */
Color look_at(MovingKind kind, const Material &material, double u, double v)
{
    if (kind == MovingKind::Turning || kind == MovingKind::Plain)
        return material.color({u, v, 0.25});
    const double z = -std::sqrt(std::max(0.0, 1.0 - u * u - v * v));
    const cv::Vec3d normal(u, v, z);
    const double light = std::max(0.0, normal.dot({-0.4, -0.7, -0.6}));
    return material.color(normal) * (0.35 + 0.75 * light);
}

cv::Vec4f sample_pixel(MovingKind kind, const Material &material, double x, double y, double radius)
{
    const double inner = (radius - 1.0) / radius;
    const int samples = is_inside(kind, x / (radius * inner), y / (radius * inner)) ? 1 : rim_samples;
    cv::Vec4d sum;
    for (int j = 0; j < samples; j++)
        for (int i = 0; i < samples; i++) {
            const double u = (x + (i + 0.5) / samples - 0.5) / radius;
            const double v = (y + (j + 0.5) / samples - 0.5) / radius;
            if (!is_inside(kind, u, v))
                continue;
            const Color color = look_at(kind, material, u, v);
            sum += cv::Vec4d(std::min(255.0, 255.0 * color[0]), std::min(255.0, 255.0 * color[1]),
                             std::min(255.0, 255.0 * color[2]), 1.0);
        }
    return sum / (samples * samples);
}

/* Size at a depth, of that at the nearest: it goes with the vergence, which is linear in depth. */
double perspective(double depth, double nearest)
{
    const double slope = 1.0 - far_over_near;
    return (1.0 - slope * depth) / (1.0 - slope * nearest);
}

/* From the sprite, whose middle is its centre, to the picture. */
cv::Matx23d placing(const MovingPose &pose, const cv::Point &middle)
{
    const double c = pose.scale * std::cos(pose.angle), s = pose.scale * std::sin(pose.angle);
    return {c, -s, pose.center.x - (c * middle.x - s * middle.y),
            s, c,  pose.center.y - (s * middle.x + c * middle.y)};
}

} // namespace

MovingThing::MovingThing(MovingKind kind, cv::Size picture, double speed, uint64_t seed)
    : kind_(kind), picture_(picture), speed_(speed),
      radius_(relative_radius * std::min(picture.width, picture.height))
{
    const Material material = material_of(kind, seed, radius_);
    const int half = static_cast<int>(std::ceil(radius_)) + 1;
    sprite_.create(2 * half + 1, 2 * half + 1);
    for (int y = -half; y <= half; y++)
        for (int x = -half; x <= half; x++)
            sprite_(y + half, x + half) = sample_pixel(kind, material, x, y, radius_);
}

MovingPose MovingThing::pose(double time) const
{
    const Look look = look_of(kind_);
    const double speed = speed_ * look.direction;
    const double way = std::max(1.0, picture_.width - 2.0 * radius_);
    const double there_and_back = std::fmod(std::abs(speed) * time, 2.0 * way);
    const double x = there_and_back < way ? there_and_back : 2.0 * way - there_and_back;
    const double depth = std::lerp(look.farthest, look.nearest, x / way);
    const double turn = kind_ == MovingKind::Turning ? speed * time / (2.0 * radius_) : 0.0;
    return {{radius_ + (speed < 0.0 ? way - x : x), look.height * picture_.height},
            turn,
            perspective(depth, look.nearest),
            depth};
}

double MovingThing::layer() const
{
    return look_of(kind_).layer;
}

double MovingThing::nearest_depth() const
{
    return look_of(kind_).nearest;
}

double MovingThing::farthest_depth() const
{
    return look_of(kind_).farthest;
}

double MovingThing::reach(double scale) const
{
    return radius_ * scale * (kind_ == MovingKind::Turning ? std::sqrt(2.0) : 1.0);
}

bool MovingThing::covers(const cv::Point2d &point, const MovingPose &at) const
{
    const cv::Point2d off = (point - at.center) / (radius_ * at.scale);
    if (off.dot(off) > 2.0)
        return false;
    const double c = std::cos(at.angle), s = std::sin(at.angle);
    return is_inside(kind_, c * off.x + s * off.y, c * off.y - s * off.x);
}

cv::Vec2d MovingThing::velocity(const cv::Point2d &point, double time) const
{
    constexpr double step = 0.01; /* planes */
    const auto where_at = [this](const cv::Point2d &off, double when) {
        const cv::Matx23d place = placing(pose(when), {});
        return cv::Vec2d(place * cv::Vec3d(off.x, off.y, 1.0));
    };
    const MovingPose at = pose(time);
    const cv::Point2d off = (point - at.center) / at.scale;
    const double c = std::cos(at.angle), s = std::sin(at.angle);
    const cv::Point2d own(c * off.x + s * off.y, c * off.y - s * off.x);
    return (where_at(own, time + step) - where_at(own, time - step)) / (2.0 * step);
}

cv::Mat4f MovingThing::draw(double time, const cv::Matx23d &warp, const cv::Rect &where) const
{
    /* Sprite to picture, then the picture's own warp, then to the part asked for. */
    const cv::Matx23d own = placing(pose(time), {sprite_.cols / 2, sprite_.rows / 2});
    const cv::Matx33d whole(own(0, 0), own(0, 1), own(0, 2), own(1, 0), own(1, 1), own(1, 2), 0.0, 0.0, 1.0);
    cv::Matx23d place = warp * whole;
    place(0, 2) -= where.x;
    place(1, 2) -= where.y;
    cv::Mat4f drawn;
    cv::warpAffine(sprite_, drawn, place, where.size(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
    return drawn;
}

std::vector<MovingThing> make_moving_things(unsigned kinds, cv::Size picture, double speed, uint64_t seed)
{
    std::vector<MovingThing> things;
    for (const MovingKind kind : {MovingKind::Ball, MovingKind::Crossing, MovingKind::Turning,
                                  MovingKind::Nearing, MovingKind::Plain})
        if (kinds & static_cast<unsigned>(kind))
            things.emplace_back(kind, picture, speed,
                                kind == MovingKind::Ball ? seed
                                                         : mix_seed(seed, static_cast<uint64_t>(kind)));
    std::stable_sort(things.begin(), things.end(),
                     [](const MovingThing &a, const MovingThing &b) { return a.layer() > b.layer(); });
    return things;
}

} // namespace dff
