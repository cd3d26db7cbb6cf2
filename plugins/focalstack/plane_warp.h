/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cmath>

#include <opencv2/core.hpp>

namespace dff {

/* A similarity of the picture plane about the picture's centre c: p goes to c + S (p - c) + d, where
 * S = [cosine -sine; sine cosine] scales and turns, and d = (dx, dy) shifts, in pixels right and down. */
struct PlaneWarp {
    double cosine = 1.0;
    double sine = 0.0;
    double dx = 0.0;
    double dy = 0.0;

    double scale() const { return std::hypot(cosine, sine); }

    /* Radians, from the x axis towards the y axis: clockwise on a screen. */
    double rotation() const { return std::atan2(sine, cosine); }

    /* Where a point goes; both as pixels from the centre. */
    cv::Point2d apply(cv::Point2d point) const
    {
        return {cosine * point.x - sine * point.y + dx, sine * point.x + cosine * point.y + dy};
    }

    PlaneWarp inverse() const
    {
        const double norm = cosine * cosine + sine * sine;
        PlaneWarp result{cosine / norm, -sine / norm, 0.0, 0.0};
        const cv::Point2d shift = result.apply({dx, dy});

        result.dx = -shift.x;
        result.dy = -shift.y;
        return result;
    }

    /* How far the corner that moves most may move in a picture of `size`, in pixels. */
    double largest_shift(cv::Size size) const
    {
        const double half_diagonal = std::hypot(size.width - 1, size.height - 1) / 2.0;

        return std::hypot(cosine - 1.0, sine) * half_diagonal + std::hypot(dx, dy);
    }

    /* The same on the pixel coordinates of a component of `size` with one sample for each `step` x `step`
     * pixels (2 for the chroma of 4:2:0), as OpenCV's 2x3 matrix. */
    cv::Matx23d matrix(cv::Size size, int step = 1) const
    {
        const cv::Point2d centre{(size.width - 1) / 2.0, (size.height - 1) / 2.0};
        const cv::Point2d shift{dx / step, dy / step};

        return {cosine, -sine,  centre.x - cosine * centre.x + sine * centre.y + shift.x,
                sine,   cosine, centre.y - sine * centre.x - cosine * centre.y + shift.y};
    }
};

} // namespace dff
