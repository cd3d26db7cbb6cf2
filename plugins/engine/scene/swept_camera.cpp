/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/swept_camera.h"

#include "engine/scene/seeds.h"
#include "optics/depth_scale.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace dff {

namespace {

/* Seeds are drawn per use, so that a change to one leaves the others alone. */
enum SeedUse : uint64_t { jitter_seed = 1, noise_seed = 2, ball_seed = 3 };

uint16_t depth_pixel(double depth)
{
    return static_cast<uint16_t>(1 + cvRound((DepthScale::max_pixel - 1) * std::clamp(depth, 0.0, 1.0)));
}

/* The scene bent as a lens does that sees the picture's corners sharp `planes` planes farther away. */
Scene bent(const Scene &scene, double planes, double last_plane)
{
    if (planes == 0.0)
        return scene;
    Scene result{scene.color, scene.depth.clone(), scene.known};
    const cv::Point2d center((scene.size().width - 1) / 2.0, (scene.size().height - 1) / 2.0);
    const double corner = std::max(center.ddot(center), 1.0);
    for (int y = 0; y < result.depth.rows; y++)
        for (int x = 0; x < result.depth.cols; x++) {
            const cv::Point2d at = cv::Point2d(x, y) - center;
            result.depth(y, x) -= static_cast<float>(planes / last_plane * at.ddot(at) / corner);
        }
    return result;
}

} // namespace

SweptCamera::SweptCamera(Scene scene, SweptCameraSettings settings, const std::stop_token &stop)
    : scene_(std::move(scene)), settings_(std::move(settings)),
      renderer_(bent(scene_, settings_.field_curvature, settings_.plan.planes() - 1.0),
                settings_.plan.planes(), settings_.blur_step, stop)
{
    if (settings_.motion == 0.0)
        return;
    std::vector<PlaneView> views;
    for (unsigned plane = 0; plane < plan().planes(); plane++)
        views.push_back(view(plane));
    overlay_.emplace(renderer_, MovingBall(size(), settings_.motion, mix_seed(settings_.seed, ball_seed)),
                     std::move(views), plan().planes() - 1.0, stop);
}

PlaneView SweptCamera::view(unsigned plane) const
{
    /* Planes need not be even in dioptres; the renderer's plane positions are. */
    const double last = plan().planes() - 1.0;
    const double focus = (plan().near() - plan().power(plane)) / (plan().near() - plan().far()) * last;
    const unsigned middle = plan().planes() / 2;
    const double beyond_middle = static_cast<double>(plane) - middle;
    const double magnification = 1.0 + settings_.breathing * beyond_middle / last;
    cv::RNG random(mix_seed(mix_seed(settings_.seed, jitter_seed), plane));
    const double x = (size().width - 1) / 2.0 * (1.0 - magnification) + random.gaussian(settings_.jitter);
    const double y = (size().height - 1) / 2.0 * (1.0 - magnification) + random.gaussian(settings_.jitter);
    return {focus, {magnification, 0.0, x, 0.0, magnification, y}};
}

double SweptCamera::time(uint64_t sweep, double plane) const
{
    return static_cast<double>(sweep * plan().planes()) + plane;
}

cv::Mat3f SweptCamera::expose(unsigned plane, const std::stop_token &stop) const
{
    const PlaneView seen = view(plane);
    return warp_picture(renderer_.render(seen.focus, stop), seen);
}

PicturePatch SweptCamera::expose_motion(uint64_t sweep, unsigned plane) const
{
    return overlay_->patch(plane, time(sweep, plane));
}

cv::Mat3b SweptCamera::digitise(const cv::Mat3f &exposed, unsigned plane, uint64_t realisation) const
{
    const uint64_t seed = mix_seed(mix_seed(settings_.seed, noise_seed), plane);
    return settings_.noise.digitise(exposed, mix_seed(seed, realisation));
}

cv::Mat1w SweptCamera::depth_map(uint64_t sweep) const
{
    cv::Mat1w map(size());
    for (int y = 0; y < map.rows; y++)
        for (int x = 0; x < map.cols; x++)
            map(y, x) = depth_pixel(scene_.depth(y, x));
    if (!scene_.known.empty())
        map.setTo(DepthScale::no_value, scene_.known == 0);
    if (!has_motion())
        return map;
    const MovingBall &ball = overlay_->ball();
    const cv::Point2d center = ball.center(time(sweep, middle_of_sweep()));
    cv::Mat1b covered(size(), uchar{0});
    cv::circle(covered, center, cvRound(ball.radius()), 255, cv::FILLED);
    covered.setTo(0, scene_.depth < MovingBall::depth);
    map.setTo(depth_pixel(MovingBall::depth), covered);
    return map;
}

} // namespace dff
