/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "board.h"
#include "board_light.h"
#include "sweep_reader.h"

#include <stdexcept>

namespace dff {

/* A sweep in which the board cannot be measured; what() says in a user's words what to do. */
class NoBoard : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/* A corner of the board in one plane. */
struct SeenCorner {
    cv::Point2d at;      /* pixels */
    double energy = 0.0; /* of the gradient around it, DN^2; 0: it was not found */
};

/* The board as one sweep shows it. */
struct BoardView {
    static constexpr double smoothing = 1.0; /* pixels; of the noise, before anything is measured */

    cv::Size picture;
    std::vector<std::vector<SeenCorner>> planes; /* each with all corners, in the board's order */
    std::vector<cv::Point2d> corners;            /* in the plane in which the board is sharpest */
    std::vector<double> focus;  /* the plane position in which each corner is sharpest; NAN */
    std::vector<double> powers; /* what the source says of the planes */
    std::vector<int> codes;     /* what the lens was told for them, -1 where that is not known */
    int window = 0;             /* half the side of what was looked at around a corner */
    std::vector<SquareLight> squares{};

    cv::Point2d middle() const;
    /* Root mean square of the distances between the corners of two views, pixels. */
    double moved_from(const BoardView &other) const;
};

/* Finds the board in the mean of sweeps that show it in the same pose. Throws NoBoard. */
BoardView measure_board(const Board &board, const std::vector<Sweep> &sweeps);

} // namespace dff
