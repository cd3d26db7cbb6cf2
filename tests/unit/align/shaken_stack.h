/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/plane_warp.h"

#include <vector>

#include <opencv2/core.hpp>

/* How a stack is taken. */
struct Shaking {
    cv::Size size{320, 240};
    unsigned planes = 10;
    double breathing = 0.03; /* change of zoom over the sweep */
    double jitter = 1.0;     /* pixels, standard deviation */
    double rotation = 0.0;   /* radians, standard deviation */
    double tilt = 0.0;       /* change of magnification over half the longer side, standard deviation */
    double blur_step = 2.0;  /* pixels of circle of confusion a plane */
    double gain = 0.0;       /* variance of the noise is gain * I + read^2 */
    double read = 0.0;
    double period = 0.0; /* pixels; the texture is a grid of keys instead */
};

/* A textured slope, near on the left and far on the right, as an unsteady camera with focus breathing sees
 * it: 8-bit pictures, and where each point of the scene lies in each of them. */
struct ShakenStack {
    explicit ShakenStack(const Shaking &shaking);

    /* How far, at the worst plane, the warps are from the truth: root mean square over the picture in pixels,
     * all relative to plane `middle`. */
    double residual(const std::vector<dff::PlaneWarp> &warps, unsigned middle) const;

    cv::Size size;
    std::vector<cv::Mat> planes;
    std::vector<dff::PlaneWarp> warps;
};
