/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/scene_shapes.h"
#include "engine/scene/swept_camera.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

using dff::MovingKind;
using dff::MovingPose;
using dff::MovingThing;
using dff::SweptCamera;
using dff::SweptCameraSettings;

namespace {

const cv::Size size(320, 240);
constexpr double radius = 0.09 * 240;
constexpr unsigned all = 31;

MovingThing thing_of(MovingKind kind)
{
    return {kind, size, 4.0, 9};
}

class EachThing : public testing::TestWithParam<MovingKind> {};

INSTANTIATE_TEST_SUITE_P(Things, EachThing,
                         testing::Values(MovingKind::Ball, MovingKind::Crossing, MovingKind::Turning,
                                         MovingKind::Nearing, MovingKind::Plain));

} // namespace

/* The thing at one time, its pixels moved by their velocities, is the thing a plane later. */
TEST_P(EachThing, moves_as_its_velocity_says)
{
    const MovingThing thing = thing_of(GetParam());
    const cv::Rect whole({}, size);
    const cv::Mat4f now = thing.draw(20.0, cv::Matx23d::eye(), whole);
    const cv::Mat4f later = thing.draw(21.0, cv::Matx23d::eye(), whole);
    cv::Mat2f path(size);
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++)
            path(y, x) = cv::Vec2d(x, y) + thing.velocity(cv::Point2d(x, y), 20.5);
    cv::Mat4f moved;
    cv::remap(later, moved, path, {}, cv::INTER_LINEAR);
    cv::Mat1b inside(size, uchar{0});
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++)
            inside(y, x) = thing.covers(cv::Point2d(x, y), thing.pose(20.0));
    EXPECT_GT(cv::countNonZero(inside), 300);
    const double pixels = cv::countNonZero(inside);
    const double away = cv::norm(moved, now, cv::NORM_L1, inside) / pixels;
    const double before = cv::norm(later, now, cv::NORM_L1, inside) / pixels;
    EXPECT_LT(away, 0.4 * before) << away << " of " << before;
}

TEST_P(EachThing, covers_what_it_draws)
{
    const MovingThing thing = thing_of(GetParam());
    const cv::Mat4f drawn = thing.draw(33.0, cv::Matx23d::eye(), cv::Rect({}, size));
    double differs = 0.0, covered = 0.0;
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++) {
            const bool covers = thing.covers(cv::Point2d(x, y), thing.pose(33.0));
            covered += covers;
            differs += std::abs(drawn(y, x)[3] - (covers ? 1.0F : 0.0F)) > 0.6F;
        }
    EXPECT_GT(covered, 300.0);
    EXPECT_LT(differs, 0.02 * covered);
}

TEST(MovingThings, turn_cross_and_come_nearer)
{
    const auto pose = [](MovingKind kind, double time) { return thing_of(kind).pose(time); };
    EXPECT_NEAR(pose(MovingKind::Turning, 10.0).angle - pose(MovingKind::Turning, 0.0).angle,
                10.0 * 4.0 / (2.0 * radius), 1e-9);
    EXPECT_LT(pose(MovingKind::Crossing, 1.0).center.x, pose(MovingKind::Crossing, 0.0).center.x);
    EXPECT_GT(pose(MovingKind::Ball, 1.0).center.x, pose(MovingKind::Ball, 0.0).center.x);
    const MovingPose far = pose(MovingKind::Nearing, 5.0), near = pose(MovingKind::Nearing, 50.0);
    EXPECT_LT(near.depth, far.depth);
    EXPECT_GT(near.scale, far.scale);
}

TEST(MovingThings, are_hidden_by_the_nearer_ones)
{
    SweptCameraSettings settings;
    settings.plan = dff::SweepPlan::even(5, 5.0, 0.5);
    settings.motion = 4.0;
    settings.objects = static_cast<unsigned>(MovingKind::Ball) | static_cast<unsigned>(MovingKind::Crossing);
    dff::Scene scene{cv::Mat3b(size, cv::Vec3b(90, 90, 90)), cv::Mat1f(size, 1.0F), {}};
    const SweptCamera camera(scene, settings);
    const double way = size.width - 2.0 * radius, crossing = way / 2.0 / 4.0; /* planes */
    const cv::Mat1w depth = camera.depth_map(static_cast<uint64_t>(crossing / 5.0));
    const cv::Point middle(160, cvRound(0.4 * 240));
    EXPECT_NEAR(depth(middle), 1 + 65534 * 0.15, 1.0);
    EXPECT_NEAR(depth(cvRound(0.45 * 240 + radius) - 2, 170), 1 + 65534 * 0.3, 1.0)
        << "what is seen of the farther one";
}

TEST(MovingThings, join_the_still_picture_without_a_seam)
{
    SweptCameraSettings settings;
    settings.motion = 4.0;
    settings.objects = all;
    settings.blur_step = 2.0;
    const SweptCamera camera(dff::make_shapes(size, 0), settings);
    for (unsigned plane = 0; plane < 6; plane++) {
        const dff::PicturePatch patch = camera.expose_motion(7, plane);
        const cv::Mat3f still = camera.expose(plane)(patch.where);
        for (const int row : {0, patch.where.height - 1})
            EXPECT_LT(cv::norm(patch.values.row(row), still.row(row), cv::NORM_INF), 0.5);
    }
}

/* A lens that jitters by more than the picture's size shows some planes none of them, and some planes one. */
TEST(MovingThings, out_of_the_picture_they_leave_it_as_it_is)
{
    const cv::Size small(64, 64);
    SweptCameraSettings settings;
    settings.plan = dff::SweepPlan::even(20, 5.0, 0.5);
    settings.motion = 4.0;
    settings.objects = all;
    settings.blur_step = 0.0;
    settings.jitter = 40.0;
    const SweptCamera camera(dff::make_shapes(small, 0), settings);
    unsigned unchanged = 0, changed = 0;
    for (unsigned plane = 0; plane < 20; plane++)
        for (uint64_t sweep = 0; sweep < 4; sweep++) {
            const cv::Mat3f still = camera.expose(plane), seen = camera.seen(still, sweep, plane);
            ASSERT_EQ(seen.size(), small);
            const cv::Rect where = camera.expose_motion(sweep, plane).where;
            cv::Mat3f outside = seen - still;
            outside(where).setTo(0.0);
            EXPECT_EQ(cv::norm(outside, cv::NORM_INF), 0.0) << "plane " << plane;
            (where.empty() ? unchanged : changed)++;
        }
    EXPECT_GT(unchanged, 0U);
    EXPECT_GT(changed, 0U);
}

TEST(MovingThings, stand_still_during_a_frozen_sweep)
{
    SweptCameraSettings settings;
    settings.plan = dff::SweepPlan::even(5, 5.0, 0.5);
    settings.motion = 6.0;
    settings.pan = 1.5;
    settings.objects = all;
    settings.blur_step = 0.0;
    const dff::Scene scene = dff::make_shapes(size, 0);
    const SweptCamera moving(scene, settings);
    settings.frozen = true;
    const SweptCamera frozen(scene, settings);
    const auto seen = [](const SweptCamera &camera, unsigned plane) {
        return camera.seen(camera.expose(plane), 4, plane);
    };
    const cv::Mat3f middle = seen(moving, 2);
    for (unsigned plane = 0; plane < 5; plane++)
        EXPECT_EQ(cv::norm(seen(frozen, plane), middle, cv::NORM_INF), 0.0);
    EXPECT_GT(cv::norm(seen(moving, 0), middle, cv::NORM_INF), 20.0);
    EXPECT_EQ(cv::norm(frozen.depth_map(4), moving.depth_map(4), cv::NORM_INF), 0.0);
}
