/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/scene_board.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <vector>

namespace dff {

namespace {

constexpr uchar white = 230, black = 25, wall = 128;
constexpr int samples = 5; /* of a pixel in each direction */

/* The numbers of a text between which `separator` stands; empty if it is anything else. */
std::vector<double> numbers_of(const std::string &text, char separator)
{
    std::vector<double> numbers;
    const char *begin = text.data(), *const end = text.data() + text.size();
    while (true) {
        double number = 0.0;
        const auto [after, error] = std::from_chars(begin, end, number);
        if (error != std::errc() || !std::isfinite(number))
            return {};
        numbers.push_back(number);
        if (after == end)
            return numbers;
        if (*after != separator)
            return {};
        begin = after + 1;
    }
}

cv::Matx33d rotation_of(const cv::Vec3d &degrees)
{
    cv::Matx33d whole = cv::Matx33d::eye();
    for (int axis = 0; axis < 3; axis++) {
        cv::Vec3d turn;
        turn[axis] = degrees[axis] * std::numbers::pi / 180.0;
        cv::Matx33d matrix;
        cv::Rodrigues(turn, matrix);
        whole = matrix * whole;
    }
    return whole;
}

/* Where rays meet the plane of the board. */
class BoardPlane {
public:
    BoardPlane(const BoardSheet &sheet, const BoardPose &pose)
        : sheet_(sheet), rotation_(rotation_of(pose.degrees)), center_(pose.metres)
    {
    }

    struct Hit {
        double z; /* metres along the axis; 0: the board is not met */
        uchar value;
    };

    Hit meet(double x, double y) const
    {
        const cv::Vec3d normal(rotation_(0, 2), rotation_(1, 2), rotation_(2, 2));
        const double z = normal.dot(center_) / normal.dot({x, y, 1.0});
        if (!(z > 0.0))
            return {0.0, wall};
        const cv::Vec3d on_board = rotation_.t() * (cv::Vec3d(x, y, 1.0) * z - center_);
        const double column = std::floor(on_board[0] * 1e3 / sheet_.square_mm + sheet_.columns / 2.0);
        const double row = std::floor(on_board[1] * 1e3 / sheet_.square_mm + sheet_.rows / 2.0);
        if (column < -1 || row < -1 || column > sheet_.columns || row > sheet_.rows)
            return {0.0, wall};
        const bool border = column < 0 || row < 0 || column >= sheet_.columns || row >= sheet_.rows;
        const bool dark = !border && std::fmod(column + row, 2.0) == 0.0;
        return {z, dark ? black : white};
    }

private:
    BoardSheet sheet_;
    cv::Matx33d rotation_;
    cv::Vec3d center_;
};

/* The rays of the middles of all pixels, and of one more column and row. */
cv::Mat2d rays_of(const CameraCalibration &camera)
{
    const int width = static_cast<int>(camera.width) + 1, height = static_cast<int>(camera.height) + 1;
    cv::Mat2d pixels(height, width);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            pixels(y, x) = {static_cast<double>(x), static_cast<double>(y)};
    const cv::Matx33d matrix(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    cv::Mat2d rays;
    cv::undistortPoints(pixels.reshape(2, 1), rays, matrix, camera.distortion, cv::noArray(), cv::noArray(),
                        cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 1e-10));
    return rays.reshape(2, height);
}

uchar mean_value(const BoardPlane &board, const cv::Mat2d &rays, int x, int y)
{
    const cv::Vec2d &ray = rays(y, x);
    const cv::Vec2d right = rays(y, x + 1) - ray, down = rays(y + 1, x) - ray;
    int sum = 0;
    for (int j = 0; j < samples; j++)
        for (int i = 0; i < samples; i++) {
            const cv::Vec2d at =
                ray + right * ((i + 0.5) / samples - 0.5) + down * ((j + 0.5) / samples - 0.5);
            sum += board.meet(at[0], at[1]).value;
        }
    return cv::saturate_cast<uchar>(static_cast<double>(sum) / (samples * samples));
}

} // namespace

std::optional<BoardPose> BoardPose::parse(const std::string &text)
{
    const std::vector<double> numbers = numbers_of(text, ',');
    if ((numbers.size() != 3 && numbers.size() != 6) || numbers[2] <= 0.0)
        return std::nullopt;
    BoardPose pose{{numbers[0], numbers[1], numbers[2]}, {}};
    if (numbers.size() == 6)
        pose.degrees = {numbers[3], numbers[4], numbers[5]};
    return pose;
}

std::optional<BoardSheet> BoardSheet::parse(const std::string &text)
{
    constexpr double most_squares = 100.0;
    const std::vector<double> numbers = numbers_of(text, 'x');
    if (numbers.size() != 3 || numbers[2] <= 0.0)
        return std::nullopt;
    for (const double squares : {numbers[0], numbers[1]})
        if (squares != std::floor(squares) || squares < 2.0 || squares > most_squares)
            return std::nullopt;
    return BoardSheet{static_cast<int>(numbers[0]), static_cast<int>(numbers[1]), numbers[2]};
}

Scene make_board(const BoardSheet &sheet, const BoardPose &pose, const CameraCalibration &camera,
                 const SweepPlan &plan)
{
    const cv::Size size(static_cast<int>(camera.width), static_cast<int>(camera.height));
    const BoardPlane board(sheet, pose);
    const cv::Mat2d rays = rays_of(camera);
    Scene scene{cv::Mat3b(size), cv::Mat1f(size), {}};
    cv::parallel_for_(cv::Range(0, size.height), [&](const cv::Range &range) {
        for (int y = range.start; y < range.end; y++)
            for (int x = 0; x < size.width; x++) {
                const double z = board.meet(rays(y, x)[0], rays(y, x)[1]).z;
                const double power = z > 0.0 ? 1.0 / z : plan.far();
                scene.depth(y, x) = static_cast<float>((plan.near() - power) / (plan.near() - plan.far()));
                scene.color(y, x) = cv::Vec3b::all(mean_value(board, rays, x, y));
            }
    });
    return scene;
}

} // namespace dff
