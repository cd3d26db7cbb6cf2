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
enum SeedUse : uint64_t { jitter_seed = 1, noise_seed = 2, ball_seed = 3, shake_seed = 4 };

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

/* What a lens lets through of a part of a picture of `whole` size that begins at `corner`. */
void darken(cv::Mat3f &part, cv::Point corner, cv::Size whole, double vignetting)
{
    if (vignetting == 0.0)
        return;
    const cv::Point2d center((whole.width - 1) / 2.0, (whole.height - 1) / 2.0);
    const double far = std::max(center.ddot(center), 1.0);
    for (int y = 0; y < part.rows; y++)
        for (int x = 0; x < part.cols; x++) {
            const cv::Point2d at = cv::Point2d(corner.x + x, corner.y + y) - center;
            part(y, x) *= static_cast<float>(1.0 - vignetting * at.ddot(at) / far);
        }
}

} // namespace

SweptCamera::SweptCamera(Scene scene, SweptCameraSettings settings, const std::stop_token &stop)
    : scene_(std::move(scene)), settings_(std::move(settings)),
      camera_motion_(settings_.pan, settings_.shake, mix_seed(settings_.seed, shake_seed)),
      renderer_(bent(scene_, settings_.field_curvature, settings_.plan.planes() - 1.0),
                settings_.plan.planes(), settings_.blur_step, stop)
{
    std::vector<MovingThing> things =
        make_moving_things(settings_.objects, size(), settings_.motion, mix_seed(settings_.seed, ball_seed));
    if (settings_.motion == 0.0 || things.empty())
        return;
    std::vector<PlaneView> views;
    for (unsigned plane = 0; plane < plan().planes(); plane++) {
        views.push_back(view(plane));
        if (!camera_motion_.is_still()) /* then seen() warps the picture as a whole */
            views.back().warp = cv::Matx23d::eye();
    }
    overlay_.emplace(renderer_, std::move(things), std::move(views), plan().planes() - 1.0, stop);
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

/* When what moves is seen in a plane. */
double SweptCamera::exposure_time(uint64_t sweep, unsigned plane) const
{
    return time(sweep, settings_.frozen ? middle_of_sweep() : plane);
}

/* How a plane is seen where the camera has turned to at a time: magnification and shift are the lens's, after
 * the turn. */
PlaneView SweptCamera::view_at(unsigned plane, double time) const
{
    PlaneView seen = view(plane);
    const cv::Point2d offset = camera_motion_.offset(time);
    seen.warp(0, 2) -= seen.warp(0, 0) * std::remainder(offset.x, 2.0 * size().width);
    seen.warp(1, 2) -= seen.warp(1, 1) * std::remainder(offset.y, 2.0 * size().height);
    return seen;
}

cv::Mat3f SweptCamera::expose(unsigned plane, const std::stop_token &stop) const
{
    const PlaneView seen = view(plane);
    cv::Mat3f picture = renderer_.render(seen.focus, stop);
    if (!camera_motion_.is_still())
        return picture; /* seen() warps it */
    picture = warp_picture(picture, seen);
    darken(picture, {}, size(), settings_.vignetting);
    return picture;
}

PicturePatch SweptCamera::expose_motion(uint64_t sweep, unsigned plane) const
{
    PicturePatch patch = overlay_->patch(plane, exposure_time(sweep, plane));
    if (camera_motion_.is_still())
        darken(patch.values, patch.where.tl(), size(), settings_.vignetting);
    return patch;
}

cv::Mat3f SweptCamera::seen(const cv::Mat3f &exposed, uint64_t sweep, unsigned plane) const
{
    cv::Mat3f picture = exposed;
    if (overlay_) {
        picture = exposed.clone();
        const PicturePatch patch = expose_motion(sweep, plane);
        if (!patch.where.empty())
            patch.values.copyTo(picture(patch.where));
    }
    if (camera_motion_.is_still())
        return picture;
    picture = warp_picture(picture, view_at(plane, exposure_time(sweep, plane)));
    darken(picture, {}, size(), settings_.vignetting);
    return picture;
}

cv::Mat3b SweptCamera::digitise(const cv::Mat3f &exposed, unsigned plane, uint64_t realisation) const
{
    const uint64_t seed = mix_seed(mix_seed(settings_.seed, noise_seed), plane);
    return settings_.noise.digitise(exposed, mix_seed(seed, realisation));
}

/* work(pixel of the picture, pixel of the scene, whether it is mirrored along x and y, and the thing that
 * hides the scene there, or nullptr). */
template <typename Work> void SweptCamera::for_each_pixel(double time, const Work &work) const
{
    std::vector<std::pair<const MovingThing *, MovingPose>> things; /* near to far */
    if (overlay_)
        for (const MovingThing &thing : overlay_->things()) /* far to near */
            things.insert(things.begin(), {&thing, thing.pose(time)});
    const cv::Point2d offset = camera_motion_.offset(time);
    for (int y = 0; y < size().height; y++) {
        const WorldPixel row = world_pixel(y + offset.y, size().height);
        for (int x = 0; x < size().width; x++) {
            const WorldPixel column = world_pixel(x + offset.x, size().width);
            const cv::Point world(column.at, row.at);
            const auto found = std::find_if(things.begin(), things.end(), [&](const auto &thing) {
                return thing.first->covers(world, thing.second) &&
                       scene_.depth(world) >= thing.first->layer();
            });
            work(cv::Point(x, y), world, cv::Vec2b(column.is_mirrored, row.is_mirrored),
                 found == things.end() ? nullptr : found->first);
        }
    }
}

cv::Mat1w SweptCamera::depth_map(uint64_t sweep) const
{
    cv::Mat1w map(size());
    const double now = time(sweep, middle_of_sweep());
    for_each_pixel(now, [&](const cv::Point &pixel, const cv::Point &world, const cv::Vec2b &,
                            const MovingThing *thing) {
        const bool is_known = thing || scene_.known.empty() || scene_.known(world) != 0;
        const double depth = thing ? thing->pose(now).depth : static_cast<double>(scene_.depth(world));
        map(pixel) = is_known ? depth_pixel(depth) : DepthScale::no_value;
    });
    return map;
}

cv::Mat2f SweptCamera::motion_map(uint64_t sweep) const
{
    cv::Mat2f map(size());
    const double now = time(sweep, middle_of_sweep());
    const cv::Vec2d camera = camera_motion_.velocity(now);
    for_each_pixel(now, [&](const cv::Point &pixel, const cv::Point &world, const cv::Vec2b &is_mirrored,
                            const MovingThing *thing) {
        cv::Vec2d velocity = thing ? thing->velocity(world, now) : cv::Vec2d();
        for (int axis = 0; axis < 2; axis++)
            velocity[axis] = (is_mirrored[axis] ? -velocity[axis] : velocity[axis]) - camera[axis];
        map(pixel) = velocity;
    });
    return map;
}

} // namespace dff
