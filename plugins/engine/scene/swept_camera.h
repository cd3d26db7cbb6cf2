/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/scene.h"
#include "engine/scene/sensor_noise.h"
#include "engine/scene/thin_lens_renderer.h"
#include "optics/sweep_plan.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace dff {

/* How the simulated camera sees its scene. */
struct SweptCameraSettings {
    SweepPlan plan = SweepPlan::even(6, 5.0, 0.0);
    double blur_step = 2.0; /* mean change of the circle of confusion from plane to plane, pixels */
    SensorNoise noise;
    double breathing = 0.0; /* magnification of the last plane minus that of the first */
    double jitter = 0.0;    /* root mean square of each plane's shift along x and y, pixels */
    uint64_t seed = 0;
};

/* A camera that sweeps its focus over a scene. Everything is a function of the settings and of the numbers of
 * sweep and plane. */
class SweptCamera {
public:
    /* The scene spans the plan's near to far. Throws std::invalid_argument if the blur is too large. Where
     * `stop` was requested, here or in expose(), the pictures are unfinished and of no use. */
    SweptCamera(Scene scene, SweptCameraSettings settings, const std::stop_token &stop = {});

    const SweepPlan &plan() const { return settings_.plan; }
    cv::Size size() const { return scene_.size(); }
    bool noisy() const { return !settings_.noise.silent(); }

    /* What the lens throws on the sensor in this plane, in 8-bit values that are not rounded. */
    cv::Mat3f expose(unsigned plane, const std::stop_token &stop = {}) const;

    /* The sensor's picture of it: `frame` numbers independent realisations of the noise. */
    cv::Mat3b digitise(const cv::Mat3f &exposed, unsigned plane, uint64_t frame) const;

    /* The true depth: pixel = 1 + round(65534 (near - d) / (near - far)), 0 where it is not known. */
    cv::Mat1w depth_map() const;

private:
    double focus(unsigned plane) const;
    cv::Matx23d warp(unsigned plane) const;

    Scene scene_;
    SweptCameraSettings settings_;
    ThinLensRenderer renderer_;
};

} // namespace dff
