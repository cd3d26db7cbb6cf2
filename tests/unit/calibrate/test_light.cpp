/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* What squares tell of light and noise, what pixels tell of themselves, and what is drawn of it. */
#include "board_light.h"
#include "calibration_plots.h"
#include "pixel_watch.h"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <unistd.h>

using namespace dff;

namespace {

const Board board{10, 7, 20.0};
const cv::Size picture(640, 480);
constexpr std::size_t planes = 4;
constexpr double gains[planes] = {1.03, 1.01, 1.0, 0.97}, losses[planes] = {0.02, 0.04, 0.05, 0.08};

/* Squares of a board whose upper left corner is at `from`, `pitch` pixels each, lit by `light` that leans. */
std::vector<SquareLight> squares_at(cv::Point2d from, double pitch, double light, double lean)
{
    std::vector<SquareLight> squares;
    const cv::Point2d center(319.5, 239.5);
    for (std::size_t z = 0; z < planes; z++)
        for (int y = 0; y < 5; y++)
            for (int x = 0; x < 8; x++) {
                const cv::Point2d at = from + pitch * cv::Point2d(x + 0.5, y + 0.5);
                const double radius = cv::norm(at - center) / cv::norm(center);
                const bool white = (x + y) % 2 == 1;
                const double value = (white ? light : 0.1 * light) * (1.0 + lean * (x - 3.5) / 4.0) *
                                     gains[z] * (1.0 - losses[z] * radius * radius);
                squares.push_back({.plane = z,
                                   .corner = static_cast<std::size_t>(9 * y + x),
                                   .at = at,
                                   .side = pitch,
                                   .value = value,
                                   .variance = 0.2 * value + 4.0,
                                   .is_white = white});
            }
    return squares;
}

std::vector<std::vector<SquareLight>> many_boards(double light = 200.0)
{
    return {squares_at({20, 20}, 40, light, 0.02),       squares_at({300, 20}, 40, 0.8 * light, -0.02),
            squares_at({20, 250}, 40, 0.9 * light, 0.0), squares_at({300, 250}, 40, light, 0.01),
            squares_at({100, 60}, 55, 0.7 * light, 0.0), squares_at({30, 30}, 70, light, 0.0)};
}

std::vector<BoardSquares> views_of(const std::vector<std::vector<SquareLight>> &boards,
                                   const std::vector<double> &focus)
{
    std::vector<BoardSquares> views;
    for (const auto &squares : boards)
        views.push_back({squares, focus});
    return views;
}

Sweep sweep_of(const cv::Mat1b &plane, std::size_t count = planes)
{
    return {std::vector<cv::Mat1b>(count, plane), std::vector<double>(count, NAN),
            std::vector<int>(count, -1)};
}

const std::vector<double> in_the_middle(54, 1.5);

} // namespace

TEST(BoardLight, gain_and_vignetting_of_each_plane_are_found_however_boards_are_lit)
{
    const auto boards = many_boards();
    const RigLight light = fit_light(board, views_of(boards, in_the_middle), picture, planes, 2.0);
    ASSERT_EQ(light.planes.size(), planes);
    EXPECT_FALSE(light.is_clipped);
    EXPECT_LT(light.residual, 0.002);
    for (std::size_t z = 0; z < planes; z++) {
        EXPECT_NEAR(light.planes[z].gain, gains[z], 0.002) << z;
        EXPECT_NEAR(light.planes[z].vignetting, losses[z], 0.01) << z;
        EXPECT_NEAR(light.planes[z].vignetting - light.planes[2].vignetting, losses[z] - losses[2], 0.002)
            << z;
        EXPECT_LT(light.planes[z].deviation, 0.02);
    }
}

TEST(BoardLight, squares_that_blur_reaches_say_nothing)
{
    const auto boards = many_boards();
    const std::vector<double> far_away(54, 60.0);
    EXPECT_TRUE(fit_light(board, views_of(boards, far_away), picture, planes, 2.0).planes.empty());
    EXPECT_FALSE(fit_noise(views_of(boards, far_away), 2.0).is_known);
}

TEST(BoardLight, white_that_is_clipped_is_told)
{
    const auto boards = many_boards(255.0 / 0.9);
    const RigLight light = fit_light(board, views_of(boards, in_the_middle), picture, planes, 2.0);
    EXPECT_TRUE(light.is_clipped);
    EXPECT_TRUE(light.planes.empty());
}

TEST(BoardLight, noise_is_a_line_over_brightness)
{
    const auto boards = many_boards();
    const RigNoise noise = fit_noise(views_of(boards, in_the_middle), 2.0);
    ASSERT_TRUE(noise.is_known);
    EXPECT_NEAR(noise.slope, 0.2, 1e-3);
    EXPECT_NEAR(noise.offset, 4.0, 0.05);
}

/* A sheet with grain of its own, which is the same in each sweep. */
TEST(BoardLight, grain_of_the_paper_is_no_noise_where_two_sweeps_show_it)
{
    cv::RNG random(3);
    cv::Mat1f sheet(480, 640);
    for (int y = 0; y < sheet.rows; y++)
        for (int x = 0; x < sheet.cols; x++)
            sheet(y, x) = ((x / 50 + y / 50) % 2 ? 200.0F : 30.0F) + static_cast<float>(random.gaussian(6.0));
    std::vector<Sweep> sweeps;
    for (int k = 0; k < 3; k++) {
        cv::Mat1b plane(sheet.size());
        for (int y = 0; y < sheet.rows; y++)
            for (int x = 0; x < sheet.cols; x++)
                plane(y, x) = cv::saturate_cast<uchar>(sheet(y, x) + random.gaussian(2.0));
        sweeps.push_back(sweep_of(plane, 1));
    }
    std::vector<cv::Point2d> corners;
    for (int y = 0; y < 6; y++)
        for (int x = 0; x < 9; x++)
            corners.emplace_back(50.0 * x + 49.5, 50.0 * y + 49.5);
    corners[53] = {NAN, NAN};
    const auto squares = measure_squares(board, sweeps, {corners});
    ASSERT_EQ(squares.size(), 39u); /* one has a corner that was not seen */
    double variance = 0.0;
    for (const SquareLight &square : squares) {
        EXPECT_EQ(square.is_white, square.value > 100.0);
        variance += square.variance / static_cast<double>(squares.size());
    }
    EXPECT_NEAR(variance, 4.0 + 1.0 / 12.0, 0.4);
    EXPECT_GT(measure_squares(board, {sweeps.front()}, {corners}).front().variance, 20.0);
}

TEST(PixelWatch, pixels_that_stand_out_before_all_boards_are_bad)
{
    PixelWatch watch;
    cv::RNG random(5);
    for (int pose = 0; pose < 4; pose++) {
        EXPECT_TRUE(watch.bad_pixels().empty() || pose > 2);
        cv::Mat1b plane(120, 160, uchar{90});
        plane(cv::Rect(20 + 15 * pose, 30, 40, 40)) = 200;
        plane(50, 100) = 200; /* a speck of the scene, in one pose */
        if (pose > 0)
            plane(50, 100) = 90;
        for (uchar &value : plane)
            value = cv::saturate_cast<uchar>(value + random.gaussian(3.0));
        plane(10, 70) = 255;
        plane(80, 33) = 0;
        watch.add(sweep_of(plane));
    }
    const std::vector<cv::Point> bad = watch.bad_pixels();
    ASSERT_EQ(bad.size(), 2u);
    EXPECT_EQ(bad[0], cv::Point(70, 10));
    EXPECT_EQ(bad[1], cv::Point(33, 80));
}

TEST(CalibrationPlots, every_diagram_is_drawn)
{
    RigCalibration found;
    found.camera.width = 640;
    found.camera.height = 480;
    found.focus.vergences = {3.0, 2.0, 1.0};
    found.points = {{0.4, {0.1, 0.2}, 2.5}, {1.4, {-0.4, 0.2}, 1.7}};
    found.light.planes = {{1.0, 0.05, 0.01}, {1.0, 0.05, 0.01}, {0.9, 0.06, 0.01}};
    found.noise = {0.2, 4.0, true};
    const std::string path = testing::TempDir() + "plots" + std::to_string(getpid()) + ".svg";
    write_plots(path, found);
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    unlink(path.c_str());
    for (const char *word : {"Corners", "Vergence", "left of focus", "Light", "Noise", "</svg>"})
        EXPECT_NE(text.str().find(word), std::string::npos) << word;
    EXPECT_EQ(text.str().find("nan"), std::string::npos);
    EXPECT_THROW(write_plots("/nowhere/plots.svg", found), std::runtime_error);
}
