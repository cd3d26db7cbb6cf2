/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

namespace dff {

/* Where something was sharp: plane position, place in the picture from its centre in half diagonals, and the
 * vergence that its distance has, in dioptres. */
struct FocusPoint {
    double plane;
    cv::Point2d at;
    double vergence;
};

/* The vergence of each plane in the picture's centre, and what the field adds to it elsewhere: field[0] x +
 * field[1] y + field[2] (x^2 + y^2). */
struct FocusSurface {
    std::vector<double> vergences;
    std::array<double, 3> field{};
    std::vector<double> deviations; /* one standard deviation of each vergence, dioptres */
    double field_deviation = 0.0;   /* of field[2] */
    double residual = 0.0;          /* robust root mean square of the points, dioptres */

    double field_at(cv::Point2d at) const
    {
        return field[0] * at.x + field[1] * at.y + field[2] * at.ddot(at);
    }
    /* Dioptres from plane to plane, in the mean. */
    double step() const;
    double vergence_at(double plane, cv::Point2d at) const;
};

/* Of the corners of so many boards, over more than a plane. */
FocusSurface fit_surface(const std::vector<FocusPoint> &points, unsigned planes, std::size_t boards);

} // namespace dff
