/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/velocity_refinement.h"

#include "focalstack/in_parallel.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace dff {

namespace {

constexpr unsigned apart = 2;      /* planes that are compared */
constexpr double noise_blur = 1.0; /* pixels */
constexpr double pooled = 12.0; /* pixels over which steps are pooled, thrice as far where little is seen */
constexpr float far_weight = 0.1F;
constexpr float least_gradient = 16.0F; /* squared, of all planes: with less nothing is known */
constexpr float most_step = 0.5F;       /* pixels a plane: more is another thing's */

/* Luma of each plane as it would be in the middle of the sweep. */
std::vector<cv::Mat1f> moved_lumas(const SmallStack &sweep, const cv::Rect &where, const cv::Mat2f &velocity)
{
    std::vector<cv::Mat1f> lumas(sweep.planes());
    in_parallel(sweep.planes(), [&](unsigned z) {
        cv::Mat2f path;
        path_through(velocity, z - (sweep.planes() - 1) / 2.0, path);
        cv::Mat1f blurred;
        cv::GaussianBlur(sweep.luma(z)(where), blurred, {}, noise_blur);
        cv::remap(blurred, lumas[z], path, {}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    });
    return lumas;
}

/* Adds what two planes say: sums of g g^T and of g times the difference a plane, g the gradient. */
void add_pair(const cv::Mat1f &first, const cv::Mat1f &second, const cv::Mat1f &weight, cv::Mat3f &squares,
              cv::Mat2f &products)
{
    for (int y = 1; y < first.rows - 1; y++)
        for (int x = 1; x < first.cols - 1; x++) {
            const float by = weight(y, x);
            if (by <= 0.0F)
                continue;
            const float gx = (first(y, x + 1) - first(y, x - 1) + second(y, x + 1) - second(y, x - 1)) / 4.0F;
            const float gy = (first(y + 1, x) - first(y - 1, x) + second(y + 1, x) - second(y - 1, x)) / 4.0F;
            const float change = (first(y, x) - second(y, x)) / static_cast<float>(apart);
            squares(y, x) += by * cv::Vec3f(gx * gx, gx * gy, gy * gy);
            products(y, x) += by * cv::Vec2f(gx * change, gy * change);
        }
}

/* Around each pixel, and fainter around that. */
template <typename Pixel> void pool(cv::Mat_<Pixel> &sums)
{
    cv::Mat near, far;
    in_parallel(2, [&](unsigned i) { soften(sums, i == 0 ? pooled : 3.0 * pooled, i == 0 ? near : far); });
    sums = near + far_weight * far;
}

/* The velocity's error, of the equations' sums. */
cv::Vec2f step_of(const cv::Vec3f &squares, const cv::Vec2f &products)
{
    const float xx = squares[0] + least_gradient * far_weight, xy = squares[1],
                yy = squares[2] + least_gradient * far_weight;
    const float determinant = xx * yy - xy * xy;
    const cv::Vec2f step =
        cv::Vec2f(yy * products[0] - xy * products[1], xx * products[1] - xy * products[0]) / determinant;
    const float length = std::hypot(step[0], step[1]);
    return length <= most_step ? step : cv::Vec2f();
}

} // namespace

void path_through(const cv::Mat2f &velocity, double planes, cv::Mat2f &path)
{
    path.create(velocity.size());
    const auto time = static_cast<float>(planes);
    for (int y = 0; y < path.rows; y++)
        for (int x = 0; x < path.cols; x++)
            path(y, x) = cv::Vec2f(static_cast<float>(x), static_cast<float>(y)) + time * velocity(y, x);
}

cv::Vec2f velocity_error(const std::vector<cv::Mat1f> &pictures, const cv::Mat1f &weight, float longest)
{
    cv::Mat3f squares = cv::Mat3f::zeros(weight.size());
    cv::Mat2f products = cv::Mat2f::zeros(weight.size());
    for (size_t z = 0; z + apart < pictures.size(); z++)
        add_pair(pictures[z], pictures[z + apart], weight, squares, products);
    const cv::Scalar a = cv::sum(squares), b = cv::sum(products);
    const double determinant = a[0] * a[2] - a[1] * a[1];
    if (determinant <= 0.0)
        return {};
    const cv::Vec2d step((a[2] * b[0] - a[1] * b[1]) / determinant,
                         (a[0] * b[1] - a[1] * b[0]) / determinant);
    return cv::norm(step) <= static_cast<double>(longest) ? cv::Vec2f(step) : cv::Vec2f();
}

void soften(const cv::Mat &from, double sigma, cv::Mat &to)
{
    const int side = static_cast<int>(std::lround(std::sqrt(4.0 * sigma * sigma + 1.0))) | 1;
    cv::blur(from, to, {side, side}, {-1, -1}, cv::BORDER_REFLECT_101);
    cv::blur(to, to, {side, side}, {-1, -1}, cv::BORDER_REFLECT_101);
    cv::blur(to, to, {side, side}, {-1, -1}, cv::BORDER_REFLECT_101);
}

void refine_velocity(const SmallStack &sweep, const cv::Rect &where, const cv::Mat1b &inside,
                     cv::Mat2f &velocity)
{
    if (cv::countNonZero(inside) == 0)
        return;
    cv::Mat1f weight;
    cv::Mat1b(inside != 0).convertTo(weight, CV_32F, 1.0 / 255.0);
    const std::vector<cv::Mat1f> lumas = moved_lumas(sweep, where, velocity);
    cv::Mat3f squares = cv::Mat3f::zeros(where.size());
    cv::Mat2f products = cv::Mat2f::zeros(where.size());
    for (size_t z = 0; z + apart < lumas.size(); z++)
        add_pair(lumas[z], lumas[z + apart], weight, squares, products);
    pool(squares);
    pool(products);
    for (int y = 0; y < velocity.rows; y++)
        for (int x = 0; x < velocity.cols; x++)
            velocity(y, x) += step_of(squares(y, x), products(y, x));
}

} // namespace dff
