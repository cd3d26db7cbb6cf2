/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/stack_aligner.h"
#include "focalstack/warp_solver.h"

#include "shaken_stack.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace {

std::vector<dff::PlaneWarp> warps_of(const std::vector<dff::PlaneAlignment> &alignments)
{
    std::vector<dff::PlaneWarp> warps;
    for (const dff::PlaneAlignment &alignment : alignments)
        warps.push_back(alignment.warp);
    return warps;
}

/* Pixels, at the worst plane; every plane must be trusted. */
double residual_of(const ShakenStack &stack)
{
    const auto alignments = dff::align_stack(stack.planes);

    EXPECT_EQ(alignments.size(), stack.planes.size());
    EXPECT_TRUE(std::ranges::all_of(alignments, &dff::PlaneAlignment::trusted));
    const double residual =
        stack.residual(warps_of(alignments), static_cast<unsigned>(dff::middle_plane(stack.planes.size())));
    ::testing::Test::RecordProperty("residual", std::to_string(residual));
    std::printf("residual %.3f px\n", residual);
    return residual;
}

std::vector<cv::Mat> make_flat_stack(double noise)
{
    std::vector<cv::Mat> planes;
    cv::RNG random(3);

    for (unsigned z = 0; z < 6; z++) {
        cv::Mat plane(120, 160, CV_8U, cv::Scalar(128));
        if (noise > 0.0)
            random.fill(plane, cv::RNG::NORMAL, 128.0, noise);
        planes.push_back(plane);
    }
    return planes;
}

void expect_left_alone(const std::vector<cv::Mat> &planes)
{
    const auto alignments = dff::align_stack(planes);

    for (std::size_t z = 0; z < planes.size(); z++) {
        EXPECT_EQ(alignments[z].trusted, z == dff::middle_plane(planes.size())) << "plane " << z;
        EXPECT_LT(alignments[z].warp.largest_shift(planes[z].size()), 1e-6) << "plane " << z;
    }
}

} // namespace

TEST(PlaneWarp, inverse_leads_back)
{
    const dff::PlaneWarp warp{1.01, 0.02, 3.0, -4.0};
    const cv::Point2d point{50.0, -20.0};

    EXPECT_NEAR(cv::norm(warp.inverse().apply(warp.apply(point)) - point), 0.0, 1e-12);
}

TEST(PlaneWarp, matrix_turns_and_zooms_about_the_centre)
{
    const dff::PlaneWarp warp{0.98, 0.01, 0.0, 0.0};
    const cv::Vec3d centre = warp.pixel_matrix({33, 17}, 2) * cv::Vec3d(16.0, 8.0, 1.0);

    EXPECT_NEAR(cv::norm(centre - cv::Vec3d(16.0, 8.0, 1.0)), 0.0, 1e-12);
}

TEST(StackAligner, jitter_and_breathing_are_found)
{
    EXPECT_LT(residual_of(ShakenStack({})), 0.1);
}

TEST(StackAligner, moderate_noise_does_not_matter_much)
{
    EXPECT_LT(residual_of(ShakenStack({.gain = 0.2, .read = 2.0})), 0.1);
}

TEST(StackAligner, strong_noise_does_not_matter_much)
{
    EXPECT_LT(residual_of(ShakenStack({.gain = 1.0, .read = 5.0})), 0.15);
}

TEST(StackAligner, a_hand_that_shakes_and_turns_is_followed)
{
    EXPECT_LT(residual_of(ShakenStack({.jitter = 8.0, .rotation = 0.01})), 0.15);
}

TEST(StackAligner, two_planes_are_enough)
{
    EXPECT_LT(residual_of(ShakenStack({.planes = 2})), 0.1);
}

TEST(StackAligner, sixty_four_planes_stay_chained)
{
    EXPECT_LT(residual_of(ShakenStack({.size = {96, 80}, .planes = 64, .blur_step = 0.3})), 0.2);
}

TEST(StackAligner, odd_sizes_are_no_different)
{
    EXPECT_LT(residual_of(ShakenStack({.size = {161, 119}, .planes = 5})), 0.15);
    EXPECT_LT(residual_of(ShakenStack({.size = {65, 67}, .planes = 3, .breathing = 0.01, .blur_step = 1.0})),
              0.2);
}

TEST(StackAligner, large_pictures_are_reduced_and_still_found)
{
    EXPECT_LT(residual_of(ShakenStack({.size = {2051, 301}, .planes = 4, .breathing = 0.01})), 0.15);
}

TEST(StackAligner, still_planes_are_not_moved)
{
    const ShakenStack stack({.breathing = 0.0, .jitter = 0.0});

    EXPECT_LT(residual_of(stack), 0.05);
}

TEST(StackAligner, colours_and_sixteen_bits_give_the_same)
{
    ShakenStack stack({.planes = 4});
    for (cv::Mat &plane : stack.planes)
        cv::merge(std::vector<cv::Mat>(4, plane), plane);
    EXPECT_LT(residual_of(stack), 0.1);

    for (cv::Mat &plane : stack.planes) {
        cv::extractChannel(plane, plane, 0);
        plane.convertTo(plane, CV_16U, 16.0);
    }
    EXPECT_LT(residual_of(stack), 0.1);
}

TEST(StackAligner, planes_of_different_brightness_are_matched)
{
    ShakenStack stack({.planes = 6});
    for (std::size_t z = 0; z < stack.planes.size(); z++)
        stack.planes[z] *= 0.5 + 0.1 * static_cast<double>(z);

    EXPECT_LT(residual_of(stack), 0.1);
}

TEST(StackAligner, an_object_that_moves_does_not_take_the_planes_along)
{
    ShakenStack stack({.planes = 6});
    const ShakenStack other({.planes = 2});
    const cv::Mat object = other.planes[1](cv::Rect(200, 100, 90, 90));

    for (std::size_t z = 0; z < stack.planes.size(); z++)
        object.copyTo(stack.planes[z](cv::Rect(20 + 4 * static_cast<int>(z), 60, 90, 90)));
    EXPECT_LT(residual_of(stack), 0.15);
}

TEST(StackAligner, a_stack_without_texture_is_left_alone)
{
    expect_left_alone(make_flat_stack(0.0));
}

TEST(StackAligner, a_stack_of_noise_is_left_alone)
{
    for (const double noise : {1.0, 8.0, 40.0})
        expect_left_alone(make_flat_stack(noise));
}

TEST(StackAligner, a_black_plane_goes_with_its_neighbours)
{
    ShakenStack stack({});
    stack.planes[2].setTo(0);
    const auto alignments = dff::align_stack(stack.planes);

    for (std::size_t z = 0; z < alignments.size(); z++)
        EXPECT_EQ(alignments[z].trusted, z != 2) << "plane " << z;

    auto warps = warps_of(alignments);
    EXPECT_NEAR(warps[2].shift().x, (warps[1].shift().x + warps[3].shift().x) / 2.0, 0.05);
    EXPECT_NEAR(warps[2].scale(), (warps[1].scale() + warps[3].scale()) / 2.0, 1e-3);

    stack.warps[2] = warps[2] = {};
    stack.warps.erase(stack.warps.begin() + 2);
    warps.erase(warps.begin() + 2);
    EXPECT_LT(stack.residual(warps, 4), 0.15);
}

TEST(StackAligner, planes_far_apart_in_focus_find_each_other)
{
    EXPECT_LT(
        residual_of(ShakenStack({.size = {512, 400}, .planes = 13, .breathing = 0.12, .blur_step = 5.0})),
        0.5);
}

TEST(StackAligner, a_hand_shakes_planes_far_apart_in_focus)
{
    EXPECT_LT(residual_of(ShakenStack({.size = {512, 400},
                                       .planes = 9,
                                       .breathing = 0.08,
                                       .jitter = 9.0,
                                       .rotation = 0.01,
                                       .blur_step = 5.0})),
              0.3);
}

/* As the smallest size tells them, beside links of a larger size: each counts for little. */
TEST(WarpSolver, few_points_outweigh_the_tie_to_the_neighbour)
{
    const cv::Point2d shift(40.0, -20.0);
    cv::RNG random(5);
    std::vector<dff::PlaneLink> links{{0, 1, {}, 2.8}, {1, 2, {}, 1.0}};
    for (int i = 0; i < 24; i++) {
        const cv::Point2d point(random.uniform(-80.0, 80.0), random.uniform(-80.0, 80.0));
        const cv::Point2d error(random.gaussian(1.0), random.gaussian(1.0));
        links[0].match.from.push_back(point);
        links[0].match.to.push_back(point + shift + error);
        links[1].match.from.push_back(point);
        links[1].match.to.push_back(point);
    }
    const std::vector<dff::PlaneWarp> start{{1.0, 0.0, shift.x, shift.y}, {}, {}};
    const auto warps = dff::solve_warps(dff::MotionModel::Similarity, start, 1, links, {444, 444});

    EXPECT_LT(cv::norm(warps[0].shift() - shift), 0.6);
}

TEST(StackAligner, a_picture_turned_by_fifteen_degrees_is_found)
{
    EXPECT_LT(residual_of(ShakenStack({.size = {400, 300}, .planes = 6, .jitter = 12.0, .rotation = 0.12})),
              0.3);
}

TEST(StackAligner, a_phone_in_the_hand_needs_a_homography)
{
    const ShakenStack stack({.planes = 6, .tilt = 0.02});
    const auto middle = static_cast<unsigned>(dff::middle_plane(stack.planes.size()));

    EXPECT_LT(residual_of(stack), 0.15);
    EXPECT_LT(stack.residual(warps_of(dff::align_stack(stack.planes, dff::MotionModel::Homography)), middle),
              0.15);
    EXPECT_GT(stack.residual(warps_of(dff::align_stack(stack.planes, dff::MotionModel::Similarity)), middle),
              0.5);
}

TEST(StackAligner, a_similarity_stays_one)
{
    const ShakenStack stack({.jitter = 3.0, .gain = 0.2, .read = 2.0});

    for (const dff::PlaneAlignment &alignment : dff::align_stack(stack.planes))
        EXPECT_TRUE(alignment.warp.is_affine());
}

TEST(StackAligner, keys_that_are_all_alike_do_not_tell_where_a_hand_went)
{
    const ShakenStack keys(
        {.size = {400, 300}, .planes = 2, .breathing = 0.0, .jitter = 0.0, .blur_step = 0.5, .period = 20.0});

    for (const int shift : {8, 12, 27}) {
        const std::vector<cv::Mat> planes{keys.planes[0](cv::Rect(shift, 3, 320, 240)).clone(),
                                          keys.planes[1](cv::Rect(0, 0, 320, 240)).clone()};
        EXPECT_FALSE(dff::align_stack(planes)[0].trusted) << shift;
    }
}

TEST(StackAligner, keys_that_are_all_alike_may_stand_still)
{
    EXPECT_LT(residual_of(ShakenStack(
                  {.planes = 4, .breathing = 0.0, .jitter = 0.5, .blur_step = 0.5, .period = 20.0})),
              0.1);
}

TEST(StackAligner, a_plane_of_another_scene_is_not_trusted)
{
    ShakenStack stack({});
    cv::flip(stack.planes[7], stack.planes[7], -1);
    const auto alignments = dff::align_stack(stack.planes);

    for (std::size_t z = 0; z < alignments.size(); z++) {
        EXPECT_EQ(alignments[z].trusted, z != 7) << "plane " << z;
        EXPECT_FALSE(alignments[z].blank);
    }
}

/* They match each other, and that says nothing of where they belong. */
TEST(StackAligner, planes_of_another_scene_go_with_the_neighbours)
{
    ShakenStack stack({.planes = 8, .breathing = 0.0, .jitter = 2.0});
    for (std::size_t z = 0; z < 3; z++)
        cv::flip(stack.planes[z], stack.planes[z], -1);
    const auto alignments = dff::align_stack(stack.planes);

    for (std::size_t z = 0; z < alignments.size(); z++) {
        EXPECT_EQ(alignments[z].trusted, z >= 3) << "plane " << z;
        EXPECT_NEAR(alignments[z].warp.scale(), 1.0, 0.01) << "plane " << z;
        EXPECT_LT(alignments[z].warp.largest_shift(stack.size), 10.0) << "plane " << z;
    }
}

TEST(StackAligner, half_a_picture_that_moves_by_itself_is_not_trusted)
{
    const ShakenStack stack({.planes = 2, .breathing = 0.0, .jitter = 0.0});
    std::vector<cv::Mat> planes{stack.planes[0], stack.planes[1].clone()};
    const cv::Rect half(160, 0, 150, 240);

    stack.planes[1](half).copyTo(planes[1](half + cv::Point(10, 0)));
    EXPECT_FALSE(dff::align_stack(planes)[0].trusted);
}
