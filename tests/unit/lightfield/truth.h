/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/light_field_parameters.h"
#include "engine/scene/scene_shapes.h"

#include <vector>

namespace dff {

/* The simulated scene from the middle, and as each off-axis camera of a row of views sees it. */
struct Truth {
    Truth(cv::Size size, const LightFieldParameters &parameters);

    /* Pixels of a view that show what the middle sees too. */
    cv::Mat1b mutually_visible(unsigned view) const;

    Scene middle;
    std::vector<Scene> views;
    std::vector<double> slopes;
    LightFieldParameters parameters;
};

/* 16-bit depth map of unit=index. */
cv::Mat1w depth_map(const Scene &scene);

/* What the renderer makes of a picture (R, G, B) and its depth map. */
cv::Mat3b render(const cv::Mat3b &color, const cv::Mat1w &depth, const LightFieldParameters &parameters,
                 cv::Size output);

/* The views that the renderer makes of a picture (R, G, B) and its depth map. */
std::vector<cv::Mat3b> render_views(const cv::Mat3b &color, const cv::Mat1w &depth,
                                    const LightFieldParameters &parameters);

/* Peak signal to noise ratio in dB, of the pixels in `mask` or, if it is empty, of all. */
double psnr(const cv::Mat3b &found, const cv::Mat3b &expected, const cv::Mat1b &mask = {});

} // namespace dff
