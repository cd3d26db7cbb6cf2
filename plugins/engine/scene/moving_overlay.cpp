/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/moving_overlay.h"

#include "engine/scene/disk_kernel.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace dff {

namespace {

/* Pixels that interpolation may touch beyond a thing. */
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

void lay_over(cv::Mat3f picture, const cv::Mat4f &layer)
{
    for (int y = 0; y < picture.rows; y++)
        for (int x = 0; x < picture.cols; x++) {
            const cv::Vec4f &pixel = layer(y, x);
            picture(y, x) = picture(y, x) * (1.0F - pixel[3]) + cv::Vec3f(pixel[0], pixel[1], pixel[2]);
        }
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

MovingOverlay::MovingOverlay(const ThinLensRenderer &renderer, std::vector<MovingThing> things,
                             const std::vector<PlaneView> &views, double depth_to_position,
                             const std::stop_token &stop)
    : things_(std::move(things)), picture_(renderer.size()), blur_step_(renderer.blur_diameter(1.0, 0.0)),
      depth_to_position_(depth_to_position)
{
    for (const PlaneView &view : views) {
        Band band{view, {}, {}};
        band.where = rows_of(band);
        const cv::Rect region = view.warped() ? cv::Rect({}, picture_) : band.where;
        for (size_t i = 0; i <= things_.size(); i++) {
            if (stop.stop_requested())
                return;
            const auto position = [&](size_t thing) { return things_[thing].layer() * depth_to_position; };
            if (i > 0 && i < things_.size() && layer_of(position(i)) == layer_of(position(i - 1))) {
                band.slabs.emplace_back();
                continue;
            }
            const cv::Mat4f slab =
                i == 0 ? renderer.render_behind(view.focus, position(0), region, stop)
                : i == things_.size()
                    ? renderer.render_before(view.focus, position(i - 1), region, stop)
                    : renderer.render_between(view.focus, position(i), position(i - 1), region, stop);
            band.slabs.push_back(warp_picture(slab, view)(band.where).clone());
        }
        bands_.push_back(std::move(band));
    }
}

double MovingOverlay::blur_of(const Band &band, double depth) const
{
    return blur_step_ * std::abs(depth * depth_to_position_ - band.view.focus);
}

cv::Rect MovingOverlay::reach_of(const Band &band, const MovingThing &thing, const MovingPose &pose) const
{
    const cv::Vec2d warped = band.view.warp * cv::Vec3d(pose.center.x, pose.center.y, 1.0);
    const double reach =
        thing.reach(pose.scale) * band.view.warp(0, 0) + disk_reach(blur_of(band, pose.depth)) + margin;
    const cv::Point from(cvFloor(warped[0] - reach), cvFloor(warped[1] - reach));
    const cv::Point to(cvCeil(warped[0] + reach), cvCeil(warped[1] + reach));
    return cv::Rect(from, to) & cv::Rect({}, picture_);
}

/* All rows that a thing may come to. */
cv::Rect MovingOverlay::rows_of(const Band &band) const
{
    cv::Rect rows;
    for (const MovingThing &thing : things_)
        for (const double depth : {thing.nearest_depth(), thing.farthest_depth()})
            rows |=
                reach_of(band, thing, {{picture_.width / 2.0, thing.pose(0.0).center.y}, 0.0, 1.0, depth});
    return {0, rows.y, picture_.width, rows.height};
}

PicturePatch MovingOverlay::patch(unsigned plane, double time) const
{
    const Band &band = bands_[plane];
    std::vector<cv::Rect> places;
    PicturePatch patch;
    for (const MovingThing &thing : things_) {
        places.push_back(reach_of(band, thing, thing.pose(time)) & band.where);
        patch.where |= places.back();
    }
    if (patch.where.empty())
        return patch;
    const cv::Rect in_band = patch.where - band.where.tl();
    cv::cvtColor(band.slabs.front()(in_band), patch.values, cv::COLOR_RGBA2RGB);
    for (size_t i = 0; i < things_.size(); i++) {
        if (!places[i].empty()) {
            const cv::Mat4f thing = blur(things_[i].draw(time, band.view.warp, places[i]),
                                         blur_of(band, things_[i].pose(time).depth));
            lay_over(patch.values(places[i] - patch.where.tl()), thing);
        }
        if (!band.slabs[i + 1].empty())
            lay_over(patch.values, band.slabs[i + 1](in_band));
    }
    return patch;
}

} // namespace dff
