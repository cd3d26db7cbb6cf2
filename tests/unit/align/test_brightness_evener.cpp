/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/brightness_evener.h"

#include "shaken_stack.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace {

/* What happened to the light of each plane: of five, the third and median one is as it was. */
const std::vector<dff::Brightness> flicker{{0.8, 0.0}, {1.1, 4.0}, {1.0, 0.0}, {0.9, -3.0}, {1.12, 0.0}};

/* A scene with large dark and bright parts, as all planes see it, blurred differently. */
std::vector<cv::Mat> make_stack(int type)
{
    const ShakenStack stack({.planes = 5, .breathing = 0.0, .jitter = 0.0, .blur_step = 3.0});
    std::vector<cv::Mat> planes;

    for (const cv::Mat &plane : stack.planes) {
        cv::Mat scene;
        plane.convertTo(scene, CV_32F, 0.5);
        for (int x = 0; x < scene.cols; x++)
            scene.col(x) += 80.0 * x / scene.cols;
        cv::merge(std::vector<cv::Mat>(static_cast<std::size_t>(CV_MAT_CN(type)), scene), scene);
        scene.convertTo(scene, type, CV_MAT_DEPTH(type) == CV_16U ? 257.0 : 1.0);
        planes.push_back(scene);
    }
    return planes;
}

std::vector<cv::Mat> flickering(const std::vector<cv::Mat> &planes)
{
    const double unit = planes.front().depth() == CV_16U ? 257.0 : 1.0;
    std::vector<cv::Mat> result(planes.size());

    for (std::size_t z = 0; z < planes.size(); z++)
        planes[z].convertTo(result[z], -1, flicker[z].gain, flicker[z].offset * unit);
    return result;
}

std::vector<dff::PlaneAlignment> in_place(std::size_t planes)
{
    return std::vector<dff::PlaneAlignment>(planes, {{}, true});
}

/* Of 255. */
double unevenness(const std::vector<cv::Mat> &planes, const std::vector<cv::Mat> &truth)
{
    double worst = 0.0;

    for (std::size_t z = 0; z < planes.size(); z++)
        worst = std::max(worst, cv::norm(planes[z], truth[z], cv::NORM_L1) /
                                    static_cast<double>(planes[z].total() *
                                                        static_cast<std::size_t>(planes[z].channels())));
    return worst / (planes.front().depth() == CV_16U ? 257.0 : 1.0);
}

class Types : public testing::TestWithParam<int> {};

} // namespace

TEST_P(Types, flicker_is_evened_out)
{
    const std::vector<cv::Mat> truth = make_stack(GetParam());
    const std::vector<cv::Mat> planes = flickering(truth);
    const std::vector<double> black(static_cast<std::size_t>(std::min(planes.front().channels(), 3)), 0.0);
    ASSERT_GT(unevenness(planes, truth), 10.0) << "the test is too easy";
    dff::even_brightness(planes, in_place(5), black);

    EXPECT_LT(unevenness({planes[0], planes[2]}, {truth[0], truth[2]}), 1.0);
    if (planes.front().channels() < 4) {
        EXPECT_LT(unevenness(planes, truth), 1.0);
    }
}

INSTANTIATE_TEST_SUITE_P(Brightness, Types, testing::Values(CV_8UC1, CV_8UC2, CV_8UC3, CV_16UC1, CV_16UC3));

TEST(Brightness, a_fourth_channel_is_no_colour)
{
    for (const auto &[type, most] : {std::pair(CV_8UC4, 255.0), std::pair(CV_16UC4, 65535.0)}) {
        std::vector<cv::Mat> planes = flickering(make_stack(type));
        for (cv::Mat &plane : planes) {
            cv::Mat fourth(plane.size(), plane.depth(), cv::Scalar::all(most));
            cv::insertChannel(fourth, plane, 3);
        }
        dff::even_brightness(planes, in_place(5), std::vector{0.0, 0.0, 0.0});

        for (const cv::Mat &plane : planes) {
            cv::Mat fourth;
            cv::extractChannel(plane, fourth, 3);
            EXPECT_EQ(cv::countNonZero(fourth != most), 0);
        }
        EXPECT_NEAR(cv::mean(planes[0])[0] / most, cv::mean(planes[2])[0] / most, 1.5 / 255.0);
    }
}

TEST(Brightness, even_planes_are_not_touched)
{
    const std::vector<cv::Mat> truth = make_stack(CV_8UC3);
    std::vector<cv::Mat> planes;
    for (const cv::Mat &plane : truth)
        planes.push_back(plane.clone());
    dff::even_brightness(planes, in_place(5), std::vector{0.0, 0.0, 0.0});

    EXPECT_EQ(unevenness(planes, truth), 0.0);
}

TEST(Brightness, what_is_clipped_does_not_count)
{
    std::vector<cv::Mat> planes = make_stack(CV_8UC1);
    for (cv::Mat &plane : planes)
        plane(cv::Rect(0, 0, 160, 240)).setTo(200);
    planes[1] *= 1.5; /* clips the left half */
    const auto found = dff::find_brightness(planes, in_place(5), std::vector{0.0});

    EXPECT_NEAR(found[1][0].gain, 1.0 / 1.5, 0.02);
    EXPECT_NEAR(found[1][0].offset, 0.0, 2.0);
}

TEST(Brightness, what_moves_does_not_count)
{
    std::vector<cv::Mat> planes = flickering(make_stack(CV_8UC1));
    for (std::size_t z = 0; z < planes.size(); z++)
        planes[z](cv::Rect(20 + 50 * static_cast<int>(z), 80, 60, 60)).setTo(230);
    const auto found = dff::find_brightness(planes, in_place(5), std::vector{0.0});

    for (std::size_t z = 0; z < planes.size(); z++)
        EXPECT_NEAR(found[z][0].apply(flicker[z].apply(100.0)), 100.0, 1.5) << "plane " << z;
}

TEST(Brightness, of_a_flat_picture_only_the_gain_differs)
{
    std::vector<cv::Mat> planes{cv::Mat(90, 120, CV_8U, cv::Scalar::all(100)),
                                cv::Mat(90, 120, CV_8U, cv::Scalar::all(120)),
                                cv::Mat(90, 120, CV_8U, cv::Scalar::all(150))};
    const auto found = dff::find_brightness(planes, in_place(3), std::vector{16.0});

    EXPECT_NEAR(found[0][0].apply(100.0), 120.0, 0.5);
    EXPECT_NEAR(found[0][0].apply(16.0), 16.0, 0.5);
    EXPECT_NEAR(found[2][0].apply(150.0), 120.0, 0.5);
}

TEST(Brightness, planes_that_are_not_trusted_are_passed_over)
{
    std::vector<cv::Mat> planes = flickering(make_stack(CV_8UC1));
    cv::flip(planes[3], planes[3], 1);
    std::vector<dff::PlaneAlignment> alignments = in_place(5);
    alignments[3].trusted = false;
    const auto found = dff::find_brightness(planes, alignments, std::vector{0.0});

    EXPECT_NEAR(found[4][0].apply(flicker[4].apply(100.0)) / found[2][0].apply(100.0), 1.0, 0.02);
}
