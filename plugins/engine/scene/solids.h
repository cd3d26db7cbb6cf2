/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <variant>

namespace dff {

/* A line of sight: origin + t direction. Axes: x right, y down, z away from the camera. */
struct Ray {
    cv::Vec3d origin;
    cv::Vec3d direction;

    cv::Vec3d at(double t) const { return origin + t * direction; }
};

/* Where a ray meets a surface. */
struct Hit {
    double t;
    cv::Vec3d normal;
};

struct Ball {
    cv::Vec3d center;
    double radius;
};

/* A box that stands upright, turned about its vertical axis by the angle of this cosine and sine. */
struct Block {
    cv::Vec3d center;
    cv::Vec3d half;
    double cosine;
    double sine;
};

/* An upright cylinder. */
struct Pillar {
    cv::Vec3d center;
    double radius;
    double half_height;
};

/* An endless plane through a point. */
struct Wall {
    cv::Vec3d center;
    cv::Vec3d normal;
};

using Solid = std::variant<Ball, Block, Pillar, Wall>;

/* The first point of the solid in front of the ray's origin. */
std::optional<Hit> intersect(const Solid &solid, const Ray &ray);

/* A point of the surface as seen from the solid itself: relative to its centre and, for a block, its edges.
 */
cv::Vec3d local_point(const Solid &solid, const cv::Vec3d &point);

} // namespace dff
