/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/disk_kernel.h"
#include "engine/scene/scene_shapes.h"
#include "engine/scene/thin_lens_renderer.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <opencv2/imgproc.hpp>

using dff::Scene;
using dff::ThinLensRenderer;

namespace {

constexpr unsigned planes = 5;

Scene flat_scene(cv::Size size, const cv::Vec3b &color, float depth)
{
    return {cv::Mat3b(size, color), cv::Mat1f(size, depth), {}};
}

/* Where the picture is brighter than half of its brightest. */
double lit_area(const cv::Mat3f &picture)
{
    cv::Mat1f red;
    cv::extractChannel(picture, red, 0);
    double brightest = 0.0;
    cv::minMaxIdx(red, nullptr, &brightest);
    return cv::countNonZero(red > brightest / 2.0);
}

} // namespace

TEST(DiskKernel, keeps_energy_and_has_the_area_of_its_disk)
{
    for (const double diameter : {0.5, 1.0, 2.0, 3.7, 8.0, 17.3}) {
        const cv::Mat1f kernel = dff::disk_kernel(diameter);
        EXPECT_EQ(kernel.cols, 2 * dff::disk_reach(diameter) + 1);
        EXPECT_NEAR(cv::sum(kernel)[0], 1.0, 1e-5);
        const double area = std::numbers::pi * diameter * diameter / 4.0;
        double brightest = 0.0;
        cv::minMaxIdx(kernel, nullptr, &brightest);
        EXPECT_NEAR(1.0 / brightest, std::max(1.0, area), 0.02 * area + 0.1) << diameter;
    }
    EXPECT_TRUE(dff::disk_kernel(0.29).empty());
}

TEST(ThinLens, a_point_becomes_a_disk_of_blur_step_times_its_distance_from_focus)
{
    Scene scene = flat_scene({201, 201}, {0, 0, 0}, 0.25F);
    scene.color(100, 100) = {255, 255, 255};
    const ThinLensRenderer renderer(scene, planes, 6.0);
    for (const double z : {0.0, 2.0, 3.0, 4.0}) {
        const double diameter = 6.0 * std::abs(1.0 - z);
        const cv::Mat3f picture = renderer.render(z);
        EXPECT_NEAR(2.0 * std::sqrt(lit_area(picture) / std::numbers::pi), diameter, 0.5) << "focus " << z;
        EXPECT_NEAR(cv::sum(picture)[0], 255.0, 0.5) << "focus " << z;
    }
    EXPECT_EQ(lit_area(renderer.render(1.0)), 1.0);
}

TEST(ThinLens, a_surface_at_any_depth_is_blurred_by_its_own_distance)
{
    for (const float depth : {0.27F, 0.28F, 0.30F, 0.31F}) {
        Scene scene = flat_scene({201, 201}, {0, 0, 0}, depth);
        scene.color(100, 100) = {255, 255, 255};
        const double diameter = 40.0 * (4.0 - 4.0 * depth);
        const cv::Mat3f picture = ThinLensRenderer(scene, planes, 40.0).render(4.0);
        EXPECT_NEAR(2.0 * std::sqrt(lit_area(picture) / std::numbers::pi), diameter, 0.5) << depth;
    }
}

TEST(ThinLens, what_is_in_focus_stays_sharp)
{
    Scene scene = flat_scene({300, 150}, {}, 0.5F);
    cv::RNG(1).fill(scene.color, cv::RNG::UNIFORM, 0, 256);
    const cv::Mat3f picture = ThinLensRenderer(scene, planes, 4.0).render(2.0);
    cv::Mat3f sharp;
    scene.color.convertTo(sharp, CV_32F);
    EXPECT_EQ(cv::norm(picture, sharp, cv::NORM_INF), 0.0);
}

TEST(ThinLens, a_uniform_picture_stays_uniform_whatever_its_depth)
{
    Scene scene = dff::make_shapes({320, 240}, 0);
    scene.color = cv::Vec3b(40, 120, 200);
    const ThinLensRenderer renderer(scene, planes, 3.0);
    for (unsigned z = 0; z < planes; z++) {
        const cv::Mat3f picture = renderer.render(z);
        const cv::Mat3f expected(picture.size(), cv::Vec3f(40, 120, 200));
        EXPECT_LT(cv::norm(picture, expected, cv::NORM_INF), 0.01) << "a seam in plane " << z;
    }
}

TEST(ThinLens, the_blurred_edge_of_a_near_object_covers_what_is_behind)
{
    Scene scene = flat_scene({200, 60}, {0, 0, 200}, 1.0F);
    const cv::Rect object(0, 0, 100, 60);
    scene.color(object) = cv::Vec3b(200, 0, 0);
    scene.depth(object) = 0.0F;
    /* Focused on the far end the near object's edge is blurred over 40 pixels. */
    const cv::Mat3f picture = ThinLensRenderer(scene, planes, 10.0).render(4.0);
    const cv::Vec3f edge = (picture(30, 99) + picture(30, 100)) / 2.0F;
    EXPECT_NEAR(edge[0], 100.0, 2.0);
    EXPECT_NEAR(edge[2], 100.0, 2.0);
    EXPECT_GT(picture(30, 112)[0], 10.0);
    EXPECT_LT(picture(30, 122)[0], 0.5);
    for (int x = 0; x < 200; x++)
        EXPECT_NEAR(picture(30, x)[0] + picture(30, x)[2], 200.0, 1.0) << "energy is lost at " << x;
}

TEST(ThinLens, the_blur_of_what_is_behind_does_not_leak_over_a_sharp_near_object)
{
    Scene scene = flat_scene({200, 60}, {0, 0, 200}, 1.0F);
    const cv::Rect object(0, 0, 100, 60);
    scene.color(object) = cv::Vec3b(200, 0, 0);
    scene.depth(object) = 0.0F;
    const cv::Mat3f picture = ThinLensRenderer(scene, planes, 10.0).render(0.0);
    EXPECT_EQ(picture(30, 99), cv::Vec3f(200, 0, 0));
    EXPECT_NEAR(picture(30, 100)[2], 200.0, 0.1);
    EXPECT_NEAR(picture(30, 100)[0], 0.0, 0.1);
}

TEST(ThinLens, tiles_leave_no_trace)
{
    /* The same scene, moved against the grid of tiles; what leaves it comes in on the other side. */
    const cv::Size size(400, 300);
    const cv::Point offset(37, 53);
    const Scene scene = dff::make_shapes(size, 3);
    Scene moved{cv::Mat3b(size), cv::Mat1f(size), {}};
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++) {
            const cv::Point from((x + offset.x) % size.width, (y + offset.y) % size.height);
            moved.color(y, x) = scene.color(from);
            moved.depth(y, x) = scene.depth(from);
        }
    const cv::Mat3f picture = ThinLensRenderer(scene, planes, 3.0).render(4.0);
    const cv::Mat3f other = ThinLensRenderer(moved, planes, 3.0).render(4.0);
    const cv::Rect inner(30, 30, 280, 180);
    EXPECT_LT(cv::norm(picture(inner + offset), other(inner), cv::NORM_INF), 0.01);
}

TEST(ThinLens, behind_and_before_make_up_the_whole)
{
    const Scene scene = dff::make_shapes({320, 240}, 0);
    const ThinLensRenderer renderer(scene, planes, 3.0);
    const cv::Rect all({}, scene.size());
    const cv::Mat4f behind = renderer.render_behind(0.0, 2.0, all);
    const cv::Mat4f before = renderer.render_before(0.0, 2.0, all);
    const cv::Mat3f whole = renderer.render(0.0);
    float worst = 0.0F;
    for (int y = 0; y < whole.rows; y++)
        for (int x = 0; x < whole.cols; x++) {
            const cv::Vec4f sum = behind(y, x) * (1.0F - before(y, x)[3]) + before(y, x);
            for (int c = 0; c < 3; c++)
                worst = std::max(worst, std::abs(sum[c] - whole(y, x)[c]));
        }
    EXPECT_LT(worst, 0.01F);
}

TEST(ThinLens, odd_and_tiny_pictures_can_be_rendered)
{
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 200), cv::Size(129, 1), cv::Size(257, 131)})
        EXPECT_EQ(ThinLensRenderer(dff::make_shapes(size, 0), planes, 8.0).render(0.0).size(), size);
}

TEST(ThinLens, rendering_ends_when_it_is_told_to)
{
    std::stop_source stop;
    stop.request_stop();
    const Scene scene = dff::make_shapes({4096, 4096}, 0, stop.get_token());
    const auto begin = std::chrono::steady_clock::now();
    const ThinLensRenderer renderer(scene, 64, 2.0, stop.get_token());
    renderer.render(0.0, stop.get_token());
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

/* Its depth may be whatever lay in the memory. */
TEST(ThinLens, a_scene_that_was_told_to_end_is_not_looked_at)
{
    std::stop_source stop;
    stop.request_stop();
    Scene scene = dff::make_shapes({64, 64}, 0);
    scene.depth.setTo(1e12F);
    EXPECT_NO_THROW(ThinLensRenderer(scene, planes, 2.0, stop.get_token()).render(0.0, stop.get_token()));
}

TEST(ThinLens, an_impossible_blur_is_refused)
{
    EXPECT_THROW(ThinLensRenderer(flat_scene({8, 8}, {}, 0.5F), 64, 100.0), std::invalid_argument);
}
