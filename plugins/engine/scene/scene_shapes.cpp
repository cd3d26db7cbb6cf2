/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/scene_shapes.h"

#include "engine/scene/material.h"
#include "engine/scene/seeds.h"
#include "engine/scene/solids.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace dff {

namespace {

/* Lengths are in units of the distance of the near end of the sweep; its far end is infinity. */
constexpr double horizon = 0.2;       /* share of the picture above it */
constexpr double ground_height = 0.5; /* below the camera */
constexpr double wall_distance = 9.0;

struct Thing {
    Solid solid;
    Material material;
};

struct Shape {
    Solid solid;
    Pattern pattern;
    Color first;
    Color second;
    double wave;
    double gloss;
};

Ball ball(double x, double z, double radius)
{
    return {{x, ground_height - radius, z}, radius};
}

Block block(double x, double z, const cv::Vec3d &half, double turn)
{
    return {{x, ground_height - half[1], z}, half, std::cos(turn), std::sin(turn)};
}

Pillar pillar(double x, double z, double radius, double half_height)
{
    return {{x, ground_height - half_height, z}, radius, half_height};
}

const Color white{0.96, 0.94, 0.88};
const Color red{0.9, 0.16, 0.14};
const Color orange{0.98, 0.55, 0.1};
const Color yellow{0.98, 0.82, 0.2};
const Color green{0.2, 0.66, 0.32};
const Color teal{0.08, 0.6, 0.62};
const Color blue{0.13, 0.35, 0.8};
const Color violet{0.52, 0.25, 0.72};

std::vector<Shape> arrangement()
{
    return {
        {Wall{{0.0, ground_height, 0.0}, {0.0, -1.0, 0.0}},
         Pattern::Checks,
         {0.86, 0.78, 0.62},
         {0.5, 0.6, 0.55},
         0.22,
         0.0},
        {Wall{{0.0, 0.0, wall_distance}, {0.0, 0.0, -1.0}}, Pattern::Rainbow, white, white, 1.6, 0.0},
        {ball(-0.27, 1.32, 0.13), Pattern::Marble, blue, white, 0.16, 0.5},
        {ball(0.33, 1.45, 0.11), Pattern::Plain, red, red, 1.0, 0.9},
        {ball(0.06, 1.75, 0.2), Pattern::Segments, orange, white, 0.2, 0.4},
        {block(-0.62, 2.2, {0.17, 0.24, 0.17}, 0.6), Pattern::Checks, green, yellow, 0.113, 0.1},
        {block(0.72, 2.3, {0.2, 0.16, 0.2}, -0.35), Pattern::Marble, violet, {0.95, 0.7, 0.8}, 0.3, 0.1},
        {pillar(0.42, 3.1, 0.17, 0.42), Pattern::Stripes, teal, white, 0.28, 0.2},
        {block(-0.2, 3.3, {0.22, 0.3, 0.22}, 0.35), Pattern::Plain, yellow, yellow, 1.0, 0.1},
        {pillar(-1.25, 3.8, 0.2, 0.55), Pattern::Segments, violet, orange, 0.4, 0.2},
        {ball(1.5, 4.2, 0.42), Pattern::Stripes, red, white, 0.3, 0.3},
        {ball(-0.85, 5.6, 0.5), Pattern::Rainbow, white, white, 0.5, 0.3},
        {block(0.95, 6.2, {0.5, 0.75, 0.4}, 0.5), Pattern::Checks, blue, {0.6, 0.82, 0.95}, 0.3, 0.1},
    };
}

double distance_of(const Solid &solid)
{
    return std::visit([](const auto &shape) { return std::max(1.0, shape.center[2]); }, solid);
}

/* A picture of things under one lamp, by following a line of sight for each pixel. */
class ShapesView {
public:
    ShapesView(cv::Size size, uint64_t seed, const Viewpoint &from)
        : focal_(shapes_focal_length(size)), center_((size.width - 1) / 2.0, horizon * size.height),
          eye_(from.offset[0], from.offset[1], 0.0), lean_(eye_ * (1.0 - from.zero_parallax))
    {
        for (const Shape &shape : arrangement()) {
            /* The finest wave of the grain is two and a half pixels long. */
            const double detail = 2.5 * distance_of(shape.solid) / focal_ / shape.wave;
            things_.push_back({shape.solid,
                               {shape.pattern, shape.first, shape.second, shape.wave, shape.gloss,
                                FractalNoise(mix_seed(seed, things_.size()), detail, 0.85)}});
        }
    }

    struct Sample {
        Color color;
        double distance;
        size_t thing;
    };

    Sample look(double x, double y) const
    {
        const Ray ray{eye_, cv::Vec3d((x - center_.x) / focal_, (y - center_.y) / focal_, 1.0) - lean_};
        Sample sample{{}, std::numeric_limits<double>::infinity(), 0};
        Hit first{};
        for (size_t i = 0; i < things_.size(); i++)
            if (const auto hit = intersect(things_[i].solid, ray); hit && hit->t < sample.distance) {
                first = *hit;
                sample.distance = hit->t;
                sample.thing = i;
            }
        sample.color = shade(things_[sample.thing], ray, first);
        return sample;
    }

    /* The mean over a pixel, for those at an outline. */
    Color smooth_look(double x, double y) const
    {
        constexpr int samples = 4;
        Color sum;
        for (int j = 0; j < samples; j++)
            for (int i = 0; i < samples; i++)
                sum += look(x + (i + 0.5) / samples - 0.5, y + (j + 0.5) / samples - 0.5).color;
        return sum / (samples * samples);
    }

private:
    Color shade(const Thing &thing, const Ray &ray, const Hit &hit) const
    {
        static const cv::Vec3d lamp = cv::normalize(cv::Vec3d(-0.45, -1.0, -0.55));
        const cv::Vec3d point = ray.at(hit.t);
        const double facing = std::max(0.0, hit.normal.dot(lamp));
        const double light = in_shadow({point + 1e-4 * hit.normal, lamp}) ? 0.0 : 1.0;
        const cv::Vec3d halfway = cv::normalize(lamp - cv::normalize(ray.direction));
        const double highlight = thing.material.gloss * std::pow(std::max(0.0, hit.normal.dot(halfway)), 40);
        const Color color = thing.material.color(local_point(thing.solid, point));
        const double sky = 0.36 - 0.1 * hit.normal[1];
        return color * (sky + 0.72 * facing * light) + Color::all(0.8 * highlight * light);
    }

    bool in_shadow(const Ray &ray) const
    {
        return std::any_of(things_.begin(), things_.end(), [&](const Thing &thing) {
            return !std::holds_alternative<Wall>(thing.solid) && intersect(thing.solid, ray);
        });
    }

    double focal_;
    cv::Point2d center_;
    cv::Vec3d eye_;
    cv::Vec3d lean_; /* of the lines of sight of a shifted camera, towards the plane of zero parallax */
    std::vector<Thing> things_;
};

bool at_outline(const cv::Mat1b &things, int x, int y)
{
    const uchar here = things(y, x);
    return here != things(y, std::max(x - 1, 0)) || here != things(y, std::min(x + 1, things.cols - 1)) ||
           here != things(std::max(y - 1, 0), x) || here != things(std::min(y + 1, things.rows - 1), x);
}

void for_each_row(int rows, const std::stop_token &stop, const std::function<void(int)> &work)
{
    cv::parallel_for_(cv::Range(0, rows), [&](const cv::Range &range) {
        for (int y = range.start; y < range.end && !stop.stop_requested(); y++)
            work(y);
    });
}

} // namespace

double shapes_focal_length(cv::Size size)
{
    return 1.1 * std::max(size.width, size.height * 4 / 3);
}

Scene make_shapes(cv::Size size, uint64_t seed, const std::stop_token &stop, const Viewpoint &from)
{
    const ShapesView view(size, seed, from);
    Scene scene{cv::Mat3b(size), cv::Mat1f(size), {}};
    cv::Mat1b things(size);
    for_each_row(size.height, stop, [&](int y) {
        for (int x = 0; x < size.width; x++) {
            const ShapesView::Sample sample = view.look(x, y);
            scene.color(y, x) = to_pixel(sample.color);
            scene.depth(y, x) = static_cast<float>(std::clamp(1.0 - 1.0 / sample.distance, 0.0, 1.0));
            things(y, x) = static_cast<uchar>(sample.thing);
        }
    });
    for_each_row(size.height, stop, [&](int y) {
        for (int x = 0; x < size.width; x++)
            if (at_outline(things, x, y))
                scene.color(y, x) = to_pixel(view.smooth_look(x, y));
    });
    return scene;
}

} // namespace dff
