/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/moving_overlay.h"

#include "engine/scene/disk_kernel.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace dff {

namespace {

/* Pixels that interpolation may touch beyond the ball. */
constexpr double margin = 3.0;

cv::Mat4f blur(const cv::Mat4f &sharp, double diameter)
{
    const cv::Mat1f kernel = disk_kernel(diameter);
    if (kernel.empty())
        return sharp;
    cv::Mat4f blurred;
    cv::filter2D(sharp, blurred, -1, kernel, {-1, -1}, 0.0, cv::BORDER_CONSTANT);
    return blurred;
}

cv::Vec3f color_of(const cv::Vec4f &pixel)
{
    return {pixel[0], pixel[1], pixel[2]};
}

} // namespace

template <typename Pixel> cv::Mat_<Pixel> warp_picture(const cv::Mat_<Pixel> &picture, const PlaneView &view)
{
    if (!view.warped())
        return picture;
    cv::Mat_<Pixel> warped;
    cv::warpAffine(picture, warped, view.warp, picture.size(), cv::INTER_LANCZOS4, cv::BORDER_REFLECT);
    return warped;
}

template cv::Mat3f warp_picture(const cv::Mat3f &, const PlaneView &);
template cv::Mat4f warp_picture(const cv::Mat4f &, const PlaneView &);

MovingOverlay::MovingOverlay(const ThinLensRenderer &renderer, MovingBall ball,
                             const std::vector<PlaneView> &views, double depth_to_position,
                             const std::stop_token &stop)
    : ball_(std::move(ball)), picture_(renderer.size())
{
    const double u = MovingBall::depth * depth_to_position;
    for (const PlaneView &view : views) {
        if (stop.stop_requested())
            return;
        Band band{view, renderer.blur_diameter(u, view.focus), {}, {}, {}};
        const cv::Rect middle = reach_of(band, {picture_.width / 2.0, ball_.center(0.0).y});
        band.where = cv::Rect(0, middle.y, picture_.width, middle.height);
        const cv::Rect region = view.warped() ? cv::Rect({}, picture_) : band.where;
        band.behind =
            warp_picture(renderer.render_behind(view.focus, u, region, stop), view)(band.where).clone();
        band.before =
            warp_picture(renderer.render_before(view.focus, u, region, stop), view)(band.where).clone();
        bands_.push_back(std::move(band));
    }
}

cv::Rect MovingOverlay::reach_of(const Band &band, const cv::Point2d &center) const
{
    const cv::Vec2d warped = band.view.warp * cv::Vec3d(center.x, center.y, 1.0);
    const double reach = ball_.radius() * band.view.warp(0, 0) + disk_reach(band.blur) + margin;
    const cv::Point from(cvFloor(warped[0] - reach), cvFloor(warped[1] - reach));
    const cv::Point to(cvCeil(warped[0] + reach), cvCeil(warped[1] + reach));
    return cv::Rect(from, to) & cv::Rect({}, picture_);
}

PicturePatch MovingOverlay::patch(unsigned plane, double time) const
{
    const Band &band = bands_[plane];
    PicturePatch patch{reach_of(band, ball_.center(time)) & band.where, {}};
    const cv::Mat4f ball = blur(ball_.draw(time, band.view.warp, patch.where), band.blur);
    const cv::Mat4f behind = band.behind(patch.where - band.where.tl());
    const cv::Mat4f before = band.before(patch.where - band.where.tl());
    patch.values.create(patch.where.size());
    for (int y = 0; y < ball.rows; y++)
        for (int x = 0; x < ball.cols; x++) {
            const cv::Vec3f below = color_of(behind(y, x)) * (1.0F - ball(y, x)[3]) + color_of(ball(y, x));
            patch.values(y, x) = below * (1.0F - before(y, x)[3]) + color_of(before(y, x));
        }
    return patch;
}

} // namespace dff
