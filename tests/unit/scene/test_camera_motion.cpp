/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/scene_shapes.h"
#include "engine/scene/swept_camera.h"

#include <cmath>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

using dff::CameraMotion;
using dff::SweptCamera;
using dff::SweptCameraSettings;

namespace {

class Panning : public testing::Test {
protected:
    Panning()
    {
        settings_.plan = dff::SweepPlan::even(6, 4.0, 0.5);
        settings_.blur_step = 0.0;
        settings_.pan = 3.0;
    }

    cv::Mat3f seen(const SweptCamera &camera, uint64_t sweep, unsigned plane) const
    {
        return camera.seen(camera.expose(plane), sweep, plane);
    }

    /* Largest difference where the picture is moved by whole pixels. */
    static double difference(const cv::Mat &a, const cv::Mat &b, int shift)
    {
        const int width = a.cols - std::abs(shift);
        return cv::norm(a(cv::Rect(std::max(shift, 0), 0, width, a.rows)),
                        b(cv::Rect(std::max(-shift, 0), 0, width, a.rows)), cv::NORM_INF);
    }

    SweptCameraSettings settings_;
    dff::Scene scene_ = dff::make_shapes({96, 64}, 3);
};

} // namespace

TEST_F(Panning, moves_the_scene_to_the_left_by_so_many_pixels_a_plane)
{
    const SweptCamera camera(scene_, settings_);
    ASSERT_TRUE(camera.has_motion());
    const cv::Mat3f first = seen(camera, 0, 0);
    EXPECT_LT(difference(first, seen(camera, 0, 2), 6), 0.01);
    EXPECT_LT(difference(first, seen(camera, 1, 0), 18), 0.01);
}

TEST_F(Panning, goes_on_through_the_mirrored_world_and_comes_back)
{
    const SweptCamera camera(scene_, settings_);
    const cv::Mat3f first = seen(camera, 0, 0);
    EXPECT_LT(difference(first, seen(camera, 10, 4), 0), 0.01) << "64 planes, twice the width";
    cv::Mat3f mirrored;
    cv::flip(first, mirrored, 1);
    EXPECT_LT(difference(mirrored, seen(camera, 5, 2), 0), 0.01) << "32 planes, the width";
}

TEST_F(Panning, true_depth_is_that_of_the_middle_of_the_sweep)
{
    settings_.plan = dff::SweepPlan::even(5, 4.0, 0.5);
    const cv::Mat1w still = SweptCamera(scene_, SweptCameraSettings{}).depth_map(0);
    const SweptCamera camera(scene_, settings_);
    EXPECT_EQ(difference(still, camera.depth_map(0), 6), 0.0);
    EXPECT_EQ(difference(still, camera.depth_map(1), 21), 0.0);
}

TEST_F(Panning, true_motion_is_that_of_the_picture)
{
    settings_.objects = static_cast<unsigned>(dff::MovingKind::Ball);
    settings_.motion = 5.0;
    const SweptCamera camera(scene_, settings_);
    const cv::Mat2f motion = camera.motion_map(0);
    const cv::Mat1w depth = camera.depth_map(0);
    EXPECT_NEAR(motion(60, 2)[0], -3.0F, 1e-3F);
    const cv::Point ball(cvRound(0.09 * 64 + 5.0 * 2.5 - 3.0 * 2.5), cvRound(0.4 * 64));
    EXPECT_NEAR(motion(ball)[0], 2.0F, 1e-3F) << "it flies faster than the camera turns";
    EXPECT_NEAR(motion(ball)[1], 0.0F, 1e-3F);
    EXPECT_NEAR(depth(ball), 1 + 65534 * 0.15, 1.0);
}

TEST_F(Panning, breathes_and_pans_at_once)
{
    /* A lens magnifies what the camera has turned to. */
    settings_.breathing = 0.1;
    const SweptCamera camera(scene_, settings_);
    SweptCameraSettings still = settings_;
    still.breathing = 0.0;
    const SweptCamera other(scene_, still);
    const cv::Mat3f breathing = seen(camera, 3, 0);
    cv::Mat3f expected;
    const double m = 1.0 - 0.1 * 3.0 / 5.0;
    cv::warpAffine(seen(other, 3, 0), expected,
                   cv::Matx23d(m, 0.0, 95.0 / 2.0 * (1.0 - m), 0.0, m, 63.0 / 2.0 * (1.0 - m)),
                   expected.size(), cv::INTER_LANCZOS4, cv::BORDER_REFLECT);
    const cv::Rect inside(10, 10, 76, 44);
    EXPECT_LT(cv::norm(breathing(inside), expected(inside), cv::NORM_L1) / (3.0 * inside.area()), 1.0);
}

TEST(CameraMotion, shakes_smoothly_by_its_root_mean_square)
{
    const CameraMotion motion(0.0, 2.0, 7);
    double squares = 0.0, fastest = 0.0;
    for (int i = 0; i < 4000; i++) {
        const cv::Point2d at = motion.offset(i);
        squares += at.dot(at);
        fastest = std::max(fastest, cv::norm(motion.velocity(i)));
        EXPECT_LT(cv::norm(motion.offset(i + 0.5) - motion.offset(i - 0.5) - cv::Point2d(motion.velocity(i))),
                  0.05);
    }
    EXPECT_NEAR(std::sqrt(squares / 4000.0 / 2.0), 2.0, 0.1);
    EXPECT_LT(fastest, 3.0);
    EXPECT_NE(motion.offset(5.0), CameraMotion(0.0, 2.0, 8).offset(5.0));
}

TEST(CameraMotion, mirrors_the_world_at_its_borders)
{
    for (const auto &[place, at, is_mirrored] :
         {std::tuple(0.0, 0, false), std::tuple(9.4, 9, false), std::tuple(10.0, 9, true),
          std::tuple(19.0, 0, true), std::tuple(20.0, 0, false), std::tuple(-1.0, 0, true),
          std::tuple(-11.0, 9, false), std::tuple(19.6, 0, false)}) {
        const dff::WorldPixel pixel = dff::world_pixel(place, 10);
        EXPECT_EQ(pixel.at, at) << place;
        EXPECT_EQ(pixel.is_mirrored, is_mirrored) << place;
    }
}
