/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>

namespace dff {

/* A homography of the picture plane about the picture's centre: pixels from the centre, right and down, go to
 * pixels from the centre. Mostly it is a similarity: it scales, turns and shifts. */
class PlaneWarp {
public:
    PlaneWarp() = default;

    /* p goes to S p + d, where S = [cosine -sine; sine cosine] scales and turns, and d = (dx, dy) shifts. */
    PlaneWarp(double cosine, double sine, double dx, double dy)
        : matrix_(cosine, -sine, dx, sine, cosine, dy, 0.0, 0.0, 1.0)
    {
    }

    /* Scaled so that its last number is 1. */
    explicit PlaneWarp(const cv::Matx33d &matrix) : matrix_(matrix * (1.0 / matrix(2, 2))) {}

    const cv::Matx33d &matrix() const { return matrix_; }
    bool is_affine() const { return matrix_(2, 0) == 0.0 && matrix_(2, 1) == 0.0; }

    /* Where a point goes. */
    cv::Point2d apply(cv::Point2d point) const
    {
        const cv::Vec3d image = matrix_ * cv::Vec3d(point.x, point.y, 1.0);
        return {image[0] / image[2], image[1] / image[2]};
    }

    PlaneWarp inverse() const { return PlaneWarp(matrix_.inv()); }

    /* Where the centre goes. */
    cv::Point2d shift() const { return {matrix_(0, 2), matrix_(1, 2)}; }

    /* Of the similarity that is nearest to the warp at the centre. */
    double scale() const { return std::hypot(cosine(), sine()); }

    /* Radians, from the x axis towards the y axis: clockwise on a screen. */
    double rotation() const { return std::atan2(sine(), cosine()); }

    /* The same warp where the pictures are larger by these factors. */
    PlaneWarp in_picture_larger_by(double x, double y) const
    {
        return PlaneWarp(cv::Matx33d(x, 0, 0, 0, y, 0, 0, 0, 1) * matrix_ *
                         cv::Matx33d(1.0 / x, 0, 0, 0, 1.0 / y, 0, 0, 0, 1));
    }

    /* How far the corner that moves most moves in a picture of `size`, in pixels. */
    double largest_shift(cv::Size size) const
    {
        const double x = (size.width - 1) / 2.0, y = (size.height - 1) / 2.0;
        double largest = 0.0;

        for (const cv::Point2d corner : {cv::Point2d{-x, -y}, {x, -y}, {-x, y}, {x, y}})
            largest = std::max(largest, cv::norm(apply(corner) - corner));
        return largest;
    }

    /* The same on the pixel coordinates of a component of `size` with one sample for each `step` x `step`
     * pixels (2 for the chroma of 4:2:0), as OpenCV's 3x3 matrix. */
    cv::Matx33d pixel_matrix(cv::Size size, int step = 1) const
    {
        const double x = (size.width - 1) / 2.0, y = (size.height - 1) / 2.0, s = step;

        return cv::Matx33d(1.0 / s, 0, x, 0, 1.0 / s, y, 0, 0, 1) * matrix_ *
               cv::Matx33d(s, 0, -s * x, 0, s, -s * y, 0, 0, 1);
    }

private:
    double cosine() const { return (linear(0, 0) + linear(1, 1)) / 2.0; }
    double sine() const { return (linear(1, 0) - linear(0, 1)) / 2.0; }

    /* The derivative of the image point at the centre. */
    double linear(int row, int column) const
    {
        return matrix_(row, column) - matrix_(row, 2) * matrix_(2, column);
    }

    cv::Matx33d matrix_ = cv::Matx33d::eye();
};

} // namespace dff
