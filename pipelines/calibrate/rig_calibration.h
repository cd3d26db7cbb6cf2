/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "board_view.h"
#include "focus_surface.h"
#include "optics/camera_calibration.h"
#include "plane_warps.h"

namespace dff {

/* Why boards do not make a calibration; what() says in a user's words what to do. */
class Refusal : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/* What is known of a camera and a lens that sweeps its focus. */
struct RigCalibration {
    CameraCalibration camera;     /* of the middle plane */
    double reprojection_px = 0.0; /* root mean square along x and y */
    double focal_deviation = 0.0; /* one standard deviation over the focal length */
    PlaneWarps warps;
    FocusSurface focus;
    double blur_step = 0.0;   /* pixels a plane */
    double aperture_mm = 0.0; /* that such a blur means */
    RigLight light;
    RigNoise noise;
    std::vector<cv::Point> bad_pixels;
    std::vector<int> codes; /* that the lens was told for the planes; empty if that is not known */
    std::size_t boards = 0;
    std::vector<FocusPoint> points; /* corners, where each was sharp */
    std::vector<std::string> weak;  /* what is weakly determined, and what would help, in words */
};

/* Throws Refusal. */
RigCalibration calibrate(const Board &board, std::vector<BoardView> views);

/* What a new recording leaves of a calibration. */
struct CalibrationCheck {
    double reprojection_px = 0.0;
    double shift_px = 0.0;           /* the largest offset of a plane */
    double vergence_planes = 0.0;    /* mean distance from the calibrated surface, planes */
    std::vector<std::string> faults; /* empty: it fits */
};

/* Throws Refusal if the views are of another picture size or number of planes. */
CalibrationCheck check(const RigCalibration &calibration, const Board &board, std::vector<BoardView> views);

} // namespace dff
