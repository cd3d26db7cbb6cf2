/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/camera_motion.h"
#include "engine/scene/moving_overlay.h"
#include "engine/scene/scene.h"
#include "engine/scene/sensor_noise.h"
#include "engine/scene/thin_lens_renderer.h"
#include "optics/sweep_plan.h"

#include <cstdint>
#include <optional>
#include <stop_token>

namespace dff {

/* How the simulated camera sees its scene. */
struct SweptCameraSettings {
    SweepPlan plan = SweepPlan::even(6, 5.0, 0.0);
    double blur_step = 2.0; /* mean change of the circle of confusion from plane to plane, pixels */
    SensorNoise noise;
    double motion = 0.0; /* pixels that objects fly from plane to plane, 0: there are none */
    unsigned objects = static_cast<unsigned>(MovingKind::Ball); /* bits of MovingKind */
    bool frozen = false;          /* what moves stands still while a sweep is taken, where it is in the
                                     middle of it */
    double pan = 0.0;             /* pixels that the camera turns to the right from plane to plane */
    double shake = 0.0;           /* root mean square of the camera's shake along x and y, pixels */
    double breathing = 0.0;       /* magnification of the last plane minus that of the first; plane
                                     planes / 2, onto which stacks are aligned, is seen as depth_map()
                                     has it */
    double field_curvature = 0.0; /* planes that what is sharp in the picture's corners lies farther away
                                     than what is sharp in its centre; grows with the square */
    double vignetting = 0.0;      /* share of the light that the picture's corners lose in each plane;
                                     grows with the square of the distance from the centre */
    double jitter = 0.0;          /* root mean square of each plane's shift along x and y, pixels */
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

    /* A sweep shows something else than the one before. */
    bool has_motion() const { return overlay_.has_value() || !camera_motion_.is_still(); }

    /* What the lens throws on the sensor in this plane of each sweep, without what moves; only seen() makes
     * a picture of it where has_motion(). */
    cv::Mat3f expose(unsigned plane, const std::stop_token &stop = {}) const;

    /* What objects there are, and all around them that they blur into; only if there are any. */
    PicturePatch expose_motion(uint64_t sweep, unsigned plane) const;

    /* What the lens throws on the sensor in this plane of this sweep, from what expose() gave. */
    cv::Mat3f seen(const cv::Mat3f &exposed, uint64_t sweep, unsigned plane) const;

    /* The sensor's picture of it: `realisation` numbers independent draws of the noise. */
    cv::Mat3b digitise(const cv::Mat3f &exposed, unsigned plane, uint64_t realisation) const;

    /* The true depth: pixel = 1 + round(65534 (near - d) / (near - far)), 0 where it is not known. What moves
     * stands where it is at middle_of_sweep(). */
    cv::Mat1w depth_map(uint64_t sweep) const;

    /* How what is seen in each pixel moves through the picture at middle_of_sweep(), pixels a plane to the
     * right and down. */
    cv::Mat2f motion_map(uint64_t sweep) const;

private:
    /* In planes after the first one. */
    double middle_of_sweep() const { return (plan().planes() - 1) / 2.0; }

    PlaneView view(unsigned plane) const;
    PlaneView view_at(unsigned plane, double time) const;
    double time(uint64_t sweep, double plane) const;
    double exposure_time(uint64_t sweep, unsigned plane) const;
    template <typename Work> void for_each_pixel(double time, const Work &work) const;

    Scene scene_;
    SweptCameraSettings settings_;
    CameraMotion camera_motion_;
    ThinLensRenderer renderer_;
    std::optional<MovingOverlay> overlay_;
};

} // namespace dff
