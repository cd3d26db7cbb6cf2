/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/scene_board.h"
#include "engine/scene/swept_camera.h"

#include <gtest/gtest.h>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

using namespace dff;

namespace {

const CameraCalibration camera{320, 240, 400.0, 410.0, 165.0, 112.0, {-0.2, 0.05, 0.002, -0.001, 0.0}};
const SweepPlan plan = SweepPlan::even(6, 4.0, 1.0);

cv::Mat1b gray_of(const cv::Mat3b &color)
{
    cv::Mat1b gray;
    cv::cvtColor(color, gray, cv::COLOR_RGB2GRAY);
    cv::GaussianBlur(gray, gray, {}, 1.0); /* corners are found more closely without stairs */
    return gray;
}

/* Tenengrad of a part. */
double sharpness(const cv::Mat &picture, const cv::Rect &part)
{
    cv::Mat1f gray, x, y;
    cv::cvtColor(picture(part), gray, cv::COLOR_RGB2GRAY);
    cv::Sobel(gray, x, CV_32F, 1, 0);
    cv::Sobel(gray, y, CV_32F, 0, 1);
    return x.dot(x) + y.dot(y);
}

} // namespace

TEST(SceneBoard, squares_meet_where_the_camera_projects_them)
{
    const BoardSheet sheet{8, 6, 20.0};
    const BoardPose pose{{0.01, -0.02, 0.4}, {20.0, -15.0, 10.0}};
    const Scene scene = make_board(sheet, pose, camera, plan);
    cv::Matx33d rotation = cv::Matx33d::eye();
    for (int axis = 0; axis < 3; axis++) {
        cv::Vec3d turn;
        cv::Matx33d matrix;
        turn[axis] = pose.degrees[axis] * std::numbers::pi / 180.0;
        cv::Rodrigues(turn, matrix);
        rotation = matrix * rotation;
    }
    std::vector<cv::Point3d> corners;
    for (int y = 1; y < sheet.rows; y++)
        for (int x = 1; x < sheet.columns; x++)
            corners.emplace_back((x - 4) * 0.02, (y - 3) * 0.02, 0.0);
    cv::Vec3d turn;
    cv::Rodrigues(rotation, turn);
    std::vector<cv::Point2d> projected;
    cv::projectPoints(corners, turn, pose.metres,
                      cv::Matx33d(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1),
                      camera.distortion, projected);
    std::vector<cv::Point2f> found(projected.begin(), projected.end());
    for (cv::Point2f &point : found)
        point += cv::Point2f(1.5F, -1.0F);
    cv::cornerSubPix(gray_of(scene.color), found, {5, 5}, {-1, -1},
                     cv::TermCriteria(cv::TermCriteria::COUNT, 60, 0));
    for (size_t k = 0; k < found.size(); k++) {
        EXPECT_NEAR(found[k].x, projected[k].x, 0.06);
        EXPECT_NEAR(found[k].y, projected[k].y, 0.06);
        const cv::Vec3d at = rotation * cv::Vec3d(corners[k].x, corners[k].y, 0.0) + pose.metres;
        EXPECT_NEAR(scene.depth(cvRound(projected[k].y), cvRound(projected[k].x)), (4.0 - 1.0 / at[2]) / 3.0,
                    0.01);
    }
}

TEST(SceneBoard, nearer_than_the_sweep_it_is_blurred_most_in_its_last_plane)
{
    const Scene scene = make_board({8, 6, 10.0}, {{0.0, 0.0, 0.22}, {}}, camera, plan);
    SweptCameraSettings settings;
    settings.plan = plan;
    const SweptCamera swept(scene, settings);
    const cv::Rect middle(120, 80, 80, 60);
    double last = 1e30;
    for (unsigned plane = 0; plane < plan.planes(); plane++) {
        const double now = sharpness(swept.expose(plane), middle);
        EXPECT_LT(now, last) << plane;
        last = now;
    }
}

TEST(SceneBoard, a_curved_field_is_sharp_farther_away_in_the_corners)
{
    /* In plane 2 by its distance; the corner of the picture says plane 0 with a field that is two planes
     * deep. */
    const Scene scene = make_board({30, 24, 10.0}, {{0.0, 0.0, 1.0 / 2.8}, {}}, camera, plan);
    SweptCameraSettings settings;
    settings.plan = plan;
    settings.field_curvature = 2.0;
    const SweptCamera swept(scene, settings);
    const auto sharpest_at = [&](const cv::Rect &part) {
        unsigned best = 0;
        for (unsigned plane = 1; plane < plan.planes(); plane++)
            if (sharpness(swept.expose(plane), part) > sharpness(swept.expose(best), part))
                best = plane;
        return best;
    };
    EXPECT_EQ(sharpest_at({140, 100, 40, 40}), 2U);
    EXPECT_EQ(sharpest_at({0, 0, 16, 16}), 0U);
    EXPECT_EQ(sharpest_at({304, 224, 16, 16}), 0U);
}

TEST(SceneBoard, texts_that_are_none_are_refused)
{
    EXPECT_TRUE(BoardSheet::parse("10x7x25.5"));
    EXPECT_TRUE(BoardPose::parse("0,0,0.5"));
    EXPECT_TRUE(BoardPose::parse("0.1,-0.2,0.5,20,0,-3"));
    for (const char *text : {"", "10x7", "10x7x0", "1x7x25", "10.5x7x25", "10x7x25x3", "10x7x25 ", "axbxc"})
        EXPECT_FALSE(BoardSheet::parse(text)) << text;
    for (const char *text : {"", "0,0", "0,0,0", "0,0,-1", "0,0,1,2", "0,0,nan", "0,0,0.5,"})
        EXPECT_FALSE(BoardPose::parse(text)) << text;
}
