/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focus_surface.h"

#include <algorithm>
#include <cmath>

namespace dff {

namespace {

/* The plane before and the share of the one behind; straight on beyond the ends. */
struct Between {
    int plane;
    double share;
};

Between between(double plane, int planes)
{
    const int before = std::clamp(static_cast<int>(std::floor(plane)), 0, planes - 2);
    return {before, plane - before};
}

cv::Mat1d row_of(const FocusPoint &point, int planes)
{
    cv::Mat1d row(1, planes + 3, 0.0);
    const Between place = between(point.plane, planes);
    row(place.plane) = 1.0 - place.share;
    row(place.plane + 1) = place.share;
    row(planes) = point.at.x;
    row(planes + 1) = point.at.y;
    row(planes + 2) = point.at.ddot(point.at);
    return row;
}

double median_of(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/* How much a point says. A corner that is sharpest at an end of the sweep is seen blurred from one side
 * alone, so that its place leans on how blur is taken to grow. */
double weight_of(const FocusPoint &point, int planes)
{
    constexpr double end = 0.5, from_one_side = 0.1;
    return point.plane < end || point.plane > planes - 1.0 - end ? from_one_side : 1.0;
}

std::vector<double> left_over(const cv::Mat1d &rows, const cv::Mat1d &right, const cv::Mat1d &solution)
{
    const cv::Mat1d left = right - rows * solution;
    return {left.begin(), left.end()};
}

double robust_deviation(std::vector<double> left)
{
    for (double &value : left)
        value = std::abs(value);
    constexpr double of_median = 1.4826; /* a normal distribution's deviation over its median absolute one */
    return of_median * median_of(std::move(left));
}

} // namespace

double FocusSurface::step() const
{
    return (vergences.front() - vergences.back()) / (static_cast<double>(vergences.size()) - 1.0);
}

double FocusSurface::vergence_at(double plane, cv::Point2d at) const
{
    const Between place = between(plane, static_cast<int>(vergences.size()));
    const auto k = static_cast<std::size_t>(place.plane);
    return std::lerp(vergences[k], vergences[k + 1], place.share) + field_at(at);
}

FocusSurface fit_surface(const std::vector<FocusPoint> &points, unsigned planes, std::size_t boards)
{
    constexpr int rounds = 10;
    constexpr double straight =
        0.1; /* of a step: how far a plane may lie off the line through its neighbours */
    const int count = static_cast<int>(planes);
    cv::Mat1d rows, right, says;
    for (const FocusPoint &point : points) {
        rows.push_back(row_of(point, count));
        right.push_back(point.vergence);
        says.push_back(weight_of(point, count));
    }
    const auto [least, most] = std::minmax_element(
        points.begin(), points.end(), [](const auto &a, const auto &b) { return a.plane < b.plane; });
    double deviation = std::abs(most->vergence - least->vergence) / (most->plane - least->plane);
    const double step = deviation;

    /* Corners of a board err together: so many of each board say something of their own. */
    constexpr double independent = 6.0;
    const double share =
        std::min(1.0, independent * static_cast<double>(boards) / static_cast<double>(points.size()));

    cv::Mat1d weights = says.clone(), solution, covariance;
    for (int round = 0; round < rounds; round++) {
        const cv::Mat1d weighted = share * rows.mul(cv::repeat(weights, 1, rows.cols));
        cv::Mat1d normal = weighted.t() * rows;
        for (int k = 1; k + 1 < count; k++) { /* the prior, that the lens moves evenly */
            cv::Mat1d bend(1, rows.cols, 0.0);
            bend(k - 1) = bend(k + 1) = 1.0;
            bend(k) = -2.0;
            normal += std::pow(deviation / (straight * step), 2.0) * (bend.t() * bend);
        }
        for (int k = count; k < count + 3; k++) /* and its field is flat within some planes */
            normal(k, k) += std::pow(deviation / (10.0 * step), 2.0);
        cv::Mat1d inverse = normal.inv(cv::DECOMP_SVD);
        solution = inverse * (weighted.t() * right);
        const std::vector<double> left = left_over(rows, right, solution);
        deviation = std::max(robust_deviation(left), 1e-6 * step);
        for (int k = 0; k < rows.rows; k++) { /* Huber */
            const double size = std::abs(left[static_cast<std::size_t>(k)]) / (1.5 * deviation);
            weights(k) = says(k) * (size <= 1.0 ? 1.0 : 1.0 / size);
        }
        covariance = inverse * (deviation * deviation);
    }
    FocusSurface surface;
    for (int k = 0; k < count; k++) {
        surface.vergences.push_back(solution(k));
        surface.deviations.push_back(std::sqrt(covariance(k, k)));
    }
    for (int k = 0; k < 3; k++)
        surface.field[static_cast<std::size_t>(k)] = solution(count + k);
    surface.field_deviation = std::sqrt(covariance(count + 2, count + 2));
    surface.residual = deviation;
    return surface;
}

} // namespace dff
