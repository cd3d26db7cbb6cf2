/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/swept_camera.h"

#include "engine/scene/seeds.h"
#include "optics/depth_scale.h"

#include <opencv2/imgproc.hpp>

namespace dff {

namespace {

/* Seeds are drawn per use, so that a change to one leaves the others alone. */
enum SeedUse : uint64_t { jitter_seed = 1, noise_seed = 2 };

} // namespace

SweptCamera::SweptCamera(Scene scene, SweptCameraSettings settings, const std::stop_token &stop)
    : scene_(std::move(scene)), settings_(std::move(settings)),
      renderer_(scene_, settings_.plan.planes(), settings_.blur_step, stop)
{
}

/* Planes need not be even in dioptres; the renderer's plane positions are. */
double SweptCamera::focus(unsigned plane) const
{
    const SweepPlan &plan = settings_.plan;
    return (plan.near() - plan.power(plane)) / (plan.near() - plan.far()) * (plan.planes() - 1);
}

cv::Matx23d SweptCamera::warp(unsigned plane) const
{
    const double magnification = 1.0 + settings_.breathing * (plane / (plan().planes() - 1.0) - 0.5);
    cv::RNG random(mix_seed(mix_seed(settings_.seed, jitter_seed), plane));
    const double x = (size().width - 1) / 2.0 * (1.0 - magnification) + random.gaussian(settings_.jitter);
    const double y = (size().height - 1) / 2.0 * (1.0 - magnification) + random.gaussian(settings_.jitter);
    return {magnification, 0.0, x, 0.0, magnification, y};
}

cv::Mat3f SweptCamera::expose(unsigned plane, const std::stop_token &stop) const
{
    cv::Mat3f picture = renderer_.render(focus(plane), stop);
    if (settings_.breathing == 0.0 && settings_.jitter == 0.0)
        return picture;
    cv::Mat3f warped;
    cv::warpAffine(picture, warped, warp(plane), size(), cv::INTER_CUBIC, cv::BORDER_REFLECT);
    return warped;
}

cv::Mat3b SweptCamera::digitise(const cv::Mat3f &exposed, unsigned plane, uint64_t frame) const
{
    const uint64_t seed = mix_seed(mix_seed(settings_.seed, noise_seed), plane);
    return settings_.noise.digitise(exposed, mix_seed(seed, frame));
}

cv::Mat1w SweptCamera::depth_map() const
{
    cv::Mat1w map;
    constexpr double steps = DepthScale::max_pixel - 1;
    scene_.depth.convertTo(map, CV_16U, steps, 1.0);
    if (!scene_.known.empty())
        map.setTo(DepthScale::no_value, scene_.known == 0);
    return map;
}

} // namespace dff
