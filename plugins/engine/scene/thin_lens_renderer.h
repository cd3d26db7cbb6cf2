/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/scene.h"
#include "engine/scene/scene_tiles.h"

#include <cmath>
#include <stop_token>
#include <vector>

namespace dff {

/* Renders a scene as a thin lens sees it: a pixel at plane position u appears, with the lens focused on z, as
 * a disk of diameter c = blur_step |u - z| pixels (the circle of confusion of a thin lens is linear in
 * dioptres). The scene is cut into layers a quarter of a plane thick that are blurred, each as the mean of
 * what lies in it, and laid over each other from far to near, each continued behind the nearer ones. */
class ThinLensRenderer {
public:
    static constexpr double layers_per_plane = 4.0;
    static constexpr int max_blur_diameter = 500;

    /* `planes` planes even in dioptres span the depths 0 to 1 of the scene; `blur_step` is in pixels a plane.
     * Throws std::invalid_argument if the blur of anything exceeds max_blur_diameter. Where `stop` was
     * requested, here or in a render call, the pictures are unfinished and of no use. */
    ThinLensRenderer(const Scene &scene, unsigned planes, double blur_step, const std::stop_token &stop = {});

    cv::Size size() const { return sharp_.size(); }

    /* The picture with the lens focused on plane position z in [0, planes - 1]; 8-bit values, not rounded. */
    cv::Mat3f render(double z, const std::stop_token &stop = {}) const;

    /* What lies at plane position u or behind it, and what lies in front, as premultiplied R, G, B and alpha
     * in 0..1; another object goes between the two. Only `region` of the picture is sure to be rendered. */
    cv::Mat4f render_behind(double z, double u, const cv::Rect &region,
                            const std::stop_token &stop = {}) const;
    cv::Mat4f render_before(double z, double u, const cv::Rect &region,
                            const std::stop_token &stop = {}) const;

    /* Likewise what lies at `nearest` or behind it, and before `farthest`. */
    cv::Mat4f render_between(double z, double nearest, double farthest, const cv::Rect &region,
                             const std::stop_token &stop = {}) const;

    /* Diameter in pixels of the circle of confusion of plane position u. */
    double blur_diameter(double u, double z) const { return blur_step_ * std::abs(u - z); }

private:
    struct Layers {
        int nearest;
        int farthest;
    };

    cv::Mat4f composite(double z, const Layers &layers, const cv::Rect &region,
                        const std::stop_token &stop) const;
    void render_tile(const SceneTile &tile, const Layers &layers, const std::vector<cv::Mat1f> &kernels,
                     cv::Mat4f &picture) const;
    cv::Rect whole() const { return {{}, size()}; }

    cv::Mat3b sharp_;
    double blur_step_;
    int nearest_ = 0;
    int farthest_ = 0;
    std::vector<double> positions_; /* of the layers */
    std::vector<SceneTile> tiles_;
};

/* Layer of a plane position. */
int layer_of(double u);

} // namespace dff
