/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "board.h"
#include "sweep_reader.h"

#include <span>

namespace dff {

/* What the inner part of a square of the board says in one plane. */
struct SquareLight {
    std::size_t plane = 0;
    std::size_t corner = 0; /* its upper left one, in the board's order */
    cv::Point2d at;         /* its middle, pixels */
    double side = 0.0;      /* the shortest, pixels */
    double value = 0.0;     /* mean, DN */
    double variance = 0.0;  /* of a pixel's noise, DN^2 */
    bool is_white = false;
};

/* The squares between corners; `corners` holds those of each plane, of which one without a place is NAN.
 * Noise is what differs from sweep to sweep or, where there is one sweep, from pixel to pixel. */
std::vector<SquareLight> measure_squares(const Board &board, const std::vector<Sweep> &sweeps,
                                         const std::vector<std::vector<cv::Point2d>> &corners);

/* A view's squares, and the plane positions in which its corners are sharp. */
struct BoardSquares {
    std::span<const SquareLight> squares;
    std::span<const double> focus;
};

/* How bright planes are: a plane shows light times gain (1 - vignetting r^2), r in half diagonals from the
 * picture's centre. The middle plane's gain is 1. */
struct PlaneLight {
    double gain = 1.0;
    double vignetting = 0.0;
    double deviation = 0.0; /* one standard deviation of the vignetting */
};

struct RigLight {
    std::vector<PlaneLight> planes; /* empty: a plane shows too few white squares, or they are clipped */
    double residual = 0.0;          /* root mean square of what is left, in parts of the light */
    bool is_clipped = false;        /* white squares are as bright as a picture can be */
};

/* From white squares that no blur reaches into. Each board may be lit as it likes, and a little unevenly. */
RigLight fit_light(const Board &board, const std::vector<BoardSquares> &views, cv::Size picture,
                   std::size_t planes, double blur_step);

/* The variance of noise at brightness I, DN^2: slope I + offset. */
struct RigNoise {
    double slope = 0.0, offset = 0.0;
    bool is_known = false;
};

RigNoise fit_noise(const std::vector<BoardSquares> &views, double blur_step);

} // namespace dff
