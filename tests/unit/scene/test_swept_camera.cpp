/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/scene_shapes.h"
#include "engine/scene/scene_slant.h"
#include "engine/scene/swept_camera.h"
#include "optics/depth_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

using dff::Scene;
using dff::SweepPlan;
using dff::SweptCamera;
using dff::SweptCameraSettings;

namespace {

/* A picture of one depth, with a cross at its centre. */
Scene flat_scene()
{
    Scene scene{cv::Mat3b(200, 200, cv::Vec3b(60, 60, 60)), cv::Mat1f(200, 200, 0.5F), {}};
    cv::RNG(1).fill(scene.color, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(scene.color, scene.color, {}, 2.0);
    return scene;
}

/* Tenengrad: mean squared gradient. */
double sharpness(const cv::Mat &picture)
{
    cv::Mat gray;
    cv::cvtColor(picture, gray, cv::COLOR_RGB2GRAY);
    cv::Mat1f x;
    cv::Mat1f y;
    cv::Sobel(gray, x, CV_32F, 1, 0);
    cv::Sobel(gray, y, CV_32F, 0, 1);
    return (x.dot(x) + y.dot(y)) / static_cast<double>(x.total());
}

} // namespace

TEST(SweptCamera, each_plane_is_sharpest_where_its_power_is)
{
    const std::array powers{4.0, 3.5, 1.0, 0.0};
    SweptCameraSettings settings;
    settings.plan = SweepPlan::at(powers);
    settings.blur_step = 6.0;
    const Scene scene = dff::make_slant({160, 401}, 0);
    const SweptCamera camera(scene, settings);
    for (const double power : powers) {
        const int row = cvRound(400.0 * power / 4.0);
        const cv::Rect strip(0, std::clamp(row - 8, 0, 384), 160, 16);
        std::array<double, 4> found{};
        for (unsigned plane = 0; plane < 4; plane++)
            found[plane] = sharpness(camera.expose(plane)(strip));
        const auto sharpest =
            static_cast<size_t>(std::max_element(found.begin(), found.end()) - found.begin());
        EXPECT_EQ(powers[sharpest], power);
    }
}

TEST(SweptCamera, true_depth_is_what_the_depth_encoder_says)
{
    SweptCameraSettings settings;
    settings.plan = SweepPlan::even(8, 4.0, 0.5);
    Scene scene = dff::make_slant({4, 300}, 0);
    scene.known = cv::Mat1b(scene.size(), uchar{255});
    scene.known(17, 2) = 0;
    const cv::Mat1w map = SweptCamera(scene, settings).depth_map(0);
    const auto encoder = dff::DepthEncoder::dioptre(settings.plan);
    for (int y = 0; y < 300; y++)
        EXPECT_NEAR(map(y, 0), encoder.encode(scene.depth(y, 0) * 7.0), 1.0);
    EXPECT_EQ(map(299, 0), 1);
    EXPECT_EQ(map(0, 0), 65535);
    EXPECT_EQ(map(17, 2), 0);
}

TEST(SweptCamera, breathing_magnifies_about_the_centre)
{
    SweptCameraSettings settings;
    settings.plan = SweepPlan::even(3, 2.0, 0.0);
    settings.blur_step = 0.0;
    const cv::Mat3f still = SweptCamera(flat_scene(), settings).expose(2);
    settings.breathing = 0.04;
    const cv::Mat3f breathing = SweptCamera(flat_scene(), settings).expose(2);
    /* The last of three planes is half of the breathing larger: what was 50 pixels off the centre is now 51
     * off. */
    const cv::Mat3f patch = breathing(cv::Rect(99 + 51 - 5, 99 - 5, 11, 11));
    cv::Mat1f difference;
    cv::matchTemplate(still(cv::Rect(99 + 40, 99 - 15, 31, 31)), patch, difference, cv::TM_SQDIFF);
    cv::Point best;
    cv::minMaxLoc(difference, nullptr, nullptr, &best);
    EXPECT_EQ(best, cv::Point(5, 10));
    EXPECT_EQ(cv::norm(SweptCamera(flat_scene(), settings).expose(1), still, cv::NORM_INF), 0.0)
        << "the middle plane keeps its size";
    settings.plan = SweepPlan::even(4, 2.0, 0.0);
    EXPECT_EQ(cv::norm(SweptCamera(flat_scene(), settings).expose(2), still, cv::NORM_INF), 0.0)
        << "planes / 2 of an even number";
}

TEST(SweptCamera, jitter_shifts_each_plane_by_its_own_amount)
{
    SweptCameraSettings settings;
    settings.plan = SweepPlan::even(16, 2.0, 0.0);
    settings.blur_step = 0.0;
    settings.jitter = 3.0;
    const SweptCamera camera(flat_scene(), settings);
    cv::Mat1f first;
    cv::cvtColor(camera.expose(0), first, cv::COLOR_RGB2GRAY);
    cv::Mat1f window;
    cv::createHanningWindow(window, first.size(), CV_32F);
    double squares = 0.0;
    for (unsigned plane = 1; plane < 16; plane++) {
        cv::Mat1f gray;
        cv::cvtColor(camera.expose(plane), gray, cv::COLOR_RGB2GRAY);
        const cv::Point2d shift = cv::phaseCorrelate(first, gray, window);
        squares += shift.dot(shift);
    }
    /* The difference of two shifts has twice the variance, along two axes. */
    const double rms = std::sqrt(squares / 15.0 / 4.0);
    EXPECT_GT(rms, 1.0);
    EXPECT_LT(rms, 6.0);
}

TEST(SweptCamera, everything_repeats_for_a_seed)
{
    SweptCameraSettings settings;
    settings.noise = *dff::SensorNoise::parse("moderate");
    settings.motion = 5.0;
    settings.jitter = 1.0;
    settings.seed = 42;
    const auto picture = [&] {
        const SweptCamera camera(dff::make_shapes({160, 120}, settings.seed), settings);
        cv::Mat3b whole = camera.digitise(camera.expose(3), 3, 0);
        const dff::PicturePatch patch = camera.expose_motion(9, 3);
        camera.digitise(patch.values, 3, 1).copyTo(whole(patch.where));
        return whole;
    };
    const cv::Mat3b first = picture();
    EXPECT_EQ(cv::norm(first, picture(), cv::NORM_INF), 0.0);
    settings.seed = 43;
    EXPECT_GT(cv::norm(first, picture(), cv::NORM_INF), 0.0);
}

TEST(SweptCamera, noise_differs_between_planes_and_realisations)
{
    SweptCameraSettings settings;
    settings.noise = *dff::SensorNoise::parse("mild");
    const SweptCamera camera(flat_scene(), settings);
    const cv::Mat3f exposed(40, 40, cv::Vec3f::all(100.0F));
    const cv::Mat3b picture = camera.digitise(exposed, 1, 1);
    EXPECT_GT(cv::norm(picture, camera.digitise(exposed, 1, 2), cv::NORM_INF), 0.0);
    EXPECT_GT(cv::norm(picture, camera.digitise(exposed, 2, 1), cv::NORM_INF), 0.0);
}

class Motion : public testing::Test {
protected:
    Motion()
    {
        settings_.blur_step = 2.0;
        settings_.motion = 4.0;
    }

    SweptCameraSettings settings_;
    Scene scene_{cv::Mat3b(240, 320, cv::Vec3b(90, 90, 90)), cv::Mat1f(240, 320, 1.0F), {}};
};

TEST_F(Motion, the_ball_moves_by_so_many_pixels_a_plane)
{
    const SweptCamera camera(scene_, settings_);
    const auto middle = [&](uint64_t sweep, unsigned plane) {
        const dff::PicturePatch patch = camera.expose_motion(sweep, plane);
        cv::Mat1f changed(patch.values.size());
        for (int y = 0; y < changed.rows; y++)
            for (int x = 0; x < changed.cols; x++)
                changed(y, x) = cv::norm(patch.values(y, x) - cv::Vec3f::all(90.0F)) > 1.0 ? 1.0F : 0.0F;
        const cv::Moments moments = cv::moments(changed);
        return moments.m10 / moments.m00 + patch.where.x;
    };
    EXPECT_NEAR(middle(2, 4) - middle(2, 0), 16.0, 0.5);
    EXPECT_NEAR(middle(3, 0) - middle(2, 0), 24.0, 0.5);
}

TEST_F(Motion, the_patch_joins_the_still_picture_without_a_seam)
{
    settings_.breathing = 0.03;
    const Scene scene = dff::make_shapes({320, 240}, 0);
    const SweptCamera camera(scene, settings_);
    for (unsigned plane = 0; plane < 6; plane++) {
        const dff::PicturePatch patch = camera.expose_motion(5, plane);
        const cv::Mat3f still = camera.expose(plane)(patch.where);
        EXPECT_LT(cv::norm(patch.values.row(0), still.row(0), cv::NORM_INF), 0.5);
        EXPECT_LT(cv::norm(patch.values.col(0), still.col(0), cv::NORM_INF), 0.5);
        EXPECT_LT(
            cv::norm(patch.values.col(patch.where.width - 1), still.col(patch.where.width - 1), cv::NORM_INF),
            0.5);
        EXPECT_GT(cv::norm(patch.values, still, cv::NORM_INF), 20.0);
    }
}

TEST_F(Motion, corners_lose_light_whatever_moves)
{
    /* Pixels that are not the gray wall by what the lens lets through: the ball's. */
    const auto count_others = [&](const cv::Mat3f &picture) {
        const cv::Point2d center(159.5, 119.5);
        int count = 0;
        for (int y = 0; y < picture.rows; y++)
            for (int x = 0; x < picture.cols; x++) {
                const double radius = cv::norm(cv::Point2d(x, y) - center) / cv::norm(center);
                const double wall = 90.0 * (1.0 - settings_.vignetting * radius * radius);
                count += std::abs(picture(y, x)[0] - wall) > 1.0 ? 1 : 0;
            }
        return count;
    };
    for (const double pan : {0.0, 1.5}) {
        settings_.pan = pan;
        settings_.vignetting = 0.0;
        const SweptCamera even(scene_, settings_);
        const int ball = count_others(even.seen(even.expose(2), 5, 2));
        settings_.vignetting = 0.2;
        const SweptCamera camera(scene_, settings_);
        const cv::Mat3f picture = camera.seen(camera.expose(2), 5, 2);
        EXPECT_NEAR(picture(0, 0)[0], 72.0, 0.1);
        EXPECT_NEAR(picture(239, 319)[0], 72.0, 0.1);
        EXPECT_GT(ball, 100);
        EXPECT_NEAR(count_others(picture), ball, 0.05 * ball);
    }
}

TEST_F(Motion, nearer_things_hide_the_ball)
{
    scene_.depth = 0.0F;
    const SweptCamera camera(scene_, settings_);
    const dff::PicturePatch patch = camera.expose_motion(5, 0);
    EXPECT_LT(cv::norm(patch.values, cv::Mat3f(patch.values.size(), cv::Vec3f::all(90.0F)), cv::NORM_INF),
              0.01);
    EXPECT_EQ(cv::countNonZero(camera.depth_map(5) != 1), 0);
}

TEST_F(Motion, true_depth_shows_the_ball_and_follows_it)
{
    const SweptCamera camera(scene_, settings_);
    const cv::Mat1b first = camera.depth_map(0) != 65535;
    const cv::Mat1b later = camera.depth_map(3) != 65535;
    EXPECT_NEAR(cv::countNonZero(first), CV_PI * 21.6 * 21.6, 60.0);
    EXPECT_EQ(cv::boundingRect(later).x - cv::boundingRect(first).x, 3 * 6 * 4);
    EXPECT_EQ(cv::boundingRect(later).y, cv::boundingRect(first).y);
}

TEST_F(Motion, the_ball_turns_at_the_sides)
{
    settings_.motion = 37.0;
    const SweptCamera camera(scene_, settings_);
    for (uint64_t sweep = 0; sweep < 20; sweep++)
        for (unsigned plane = 0; plane < 6; plane++)
            EXPECT_GT(camera.expose_motion(sweep, plane).where.width, 40);
}
