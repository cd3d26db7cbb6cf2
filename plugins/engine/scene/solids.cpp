/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/solids.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dff {

namespace {

/* A ray that starts on a surface does not meet it again at once. */
constexpr double nearest = 1e-6;

/* From the camera's axes to those of the block, and back. */
cv::Vec3d to_block(const Block &block, const cv::Vec3d &v)
{
    return {block.cosine * v[0] + block.sine * v[2], v[1], block.cosine * v[2] - block.sine * v[0]};
}

cv::Vec3d from_block(const Block &block, const cv::Vec3d &v)
{
    return {block.cosine * v[0] - block.sine * v[2], v[1], block.cosine * v[2] + block.sine * v[0]};
}

std::optional<Hit> meet(const Ball &ball, const Ray &ray)
{
    const cv::Vec3d offset = ray.origin - ball.center;
    const double a = ray.direction.dot(ray.direction);
    const double b = offset.dot(ray.direction);
    const double root = b * b - a * (offset.dot(offset) - ball.radius * ball.radius);
    if (root < 0.0)
        return std::nullopt;
    const double t = (-b - std::sqrt(root)) / a;
    if (t < nearest)
        return std::nullopt;
    return Hit{t, (ray.at(t) - ball.center) / ball.radius};
}

std::optional<Hit> meet(const Block &block, const Ray &ray)
{
    const cv::Vec3d origin = to_block(block, ray.origin - block.center);
    const cv::Vec3d direction = to_block(block, ray.direction);
    double enter = -std::numeric_limits<double>::infinity();
    double leave = std::numeric_limits<double>::infinity();
    int face = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double a = (-block.half[axis] - origin[axis]) / direction[axis];
        const double b = (block.half[axis] - origin[axis]) / direction[axis];
        if (std::min(a, b) > enter) {
            enter = std::min(a, b);
            face = axis;
        }
        leave = std::min(leave, std::max(a, b));
    }
    if (enter > leave || enter < nearest)
        return std::nullopt;
    cv::Vec3d normal;
    normal[face] = direction[face] > 0.0 ? -1.0 : 1.0;
    return Hit{enter, from_block(block, normal)};
}

std::optional<Hit> meet_mantle(const Pillar &pillar, const Ray &ray, const cv::Vec3d &offset)
{
    const double a = ray.direction[0] * ray.direction[0] + ray.direction[2] * ray.direction[2];
    const double b = offset[0] * ray.direction[0] + offset[2] * ray.direction[2];
    const double c = offset[0] * offset[0] + offset[2] * offset[2] - pillar.radius * pillar.radius;
    const double root = b * b - a * c;
    if (root < 0.0)
        return std::nullopt;
    const double t = (-b - std::sqrt(root)) / a;
    const cv::Vec3d point = offset + t * ray.direction;
    if (t < nearest || std::abs(point[1]) > pillar.half_height)
        return std::nullopt;
    return Hit{t, cv::Vec3d(point[0], 0.0, point[2]) / pillar.radius};
}

std::optional<Hit> meet(const Pillar &pillar, const Ray &ray)
{
    const cv::Vec3d offset = ray.origin - pillar.center;
    if (auto hit = meet_mantle(pillar, ray, offset))
        return hit;
    const double t = (-pillar.half_height - offset[1]) / ray.direction[1];
    const cv::Vec3d point = offset + t * ray.direction;
    if (!(t >= nearest) || std::hypot(point[0], point[2]) > pillar.radius)
        return std::nullopt;
    return Hit{t, {0.0, -1.0, 0.0}};
}

std::optional<Hit> meet(const Wall &wall, const Ray &ray)
{
    const double t = (wall.center - ray.origin).dot(wall.normal) / ray.direction.dot(wall.normal);
    if (!(t >= nearest))
        return std::nullopt;
    return Hit{t, wall.normal};
}

} // namespace

std::optional<Hit> intersect(const Solid &solid, const Ray &ray)
{
    return std::visit([&](const auto &shape) { return meet(shape, ray); }, solid);
}

cv::Vec3d local_point(const Solid &solid, const cv::Vec3d &point)
{
    const cv::Vec3d offset = point - std::visit([](const auto &shape) { return shape.center; }, solid);
    if (const auto *block = std::get_if<Block>(&solid))
        return to_block(*block, offset);
    return offset;
}

} // namespace dff
