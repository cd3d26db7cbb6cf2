/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/scene_files.h"
#include "engine/scene/scene_shapes.h"
#include "engine/scene/scene_slant.h"

#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <sys/stat.h>
#include <unistd.h>

using dff::Scene;

namespace {

/* Files that go with the test. */
class SceneFiles : public testing::Test {
protected:
    SceneFiles() : folder_(std::filesystem::temp_directory_path() / ("dff-scene-" + std::to_string(getpid())))
    {
        std::filesystem::create_directory(folder_);
    }

    ~SceneFiles() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string &name, const cv::Mat &picture)
    {
        const std::string path = folder_ / name;
        cv::imwrite(path, picture);
        return path;
    }

    std::string path(const std::string &name) { return folder_ / name; }

private:
    std::filesystem::path folder_;
};

std::string message_of(const std::function<void()> &work)
{
    try {
        work();
    } catch (const std::runtime_error &error) {
        return error.what();
    }
    return "";
}

/* Share of pixels whose surroundings have any contrast. */
double textured_share(const Scene &scene)
{
    cv::Mat1b gray;
    cv::cvtColor(scene.color, gray, cv::COLOR_RGB2GRAY);
    cv::Mat1b largest;
    cv::Mat1b smallest;
    cv::dilate(gray, largest, cv::Mat1b::ones(5, 5));
    cv::erode(gray, smallest, cv::Mat1b::ones(5, 5));
    return cv::countNonZero(largest - smallest > 8) / static_cast<double>(gray.total());
}

} // namespace

TEST_F(SceneFiles, larger_disparity_is_nearer_and_the_ends_are_percentiles)
{
    cv::Mat1w disparity(10, 1000);
    for (int x = 0; x < disparity.cols; x++)
        disparity.col(x) = 1000 + 10 * x;
    const Scene scene = dff::load_scene(write("i.png", cv::Mat3b(10, 1000)), write("d.png", disparity));
    EXPECT_EQ(scene.depth(5, 999), 0.0F);
    EXPECT_EQ(scene.depth(5, 0), 1.0F);
    EXPECT_EQ(scene.depth(5, 1), 1.0F) << "beyond the percentile";
    EXPECT_GT(scene.depth(5, 3), scene.depth(5, 4));
    EXPECT_NEAR(scene.depth(5, 500), 0.499, 0.002);
    EXPECT_EQ(cv::countNonZero(scene.known), 10 * 1000);
}

TEST_F(SceneFiles, unknown_disparity_is_filled_from_the_farther_neighbour)
{
    cv::Mat1b disparity(5, 8, uchar{200});
    disparity.colRange(0, 4) = 50;
    disparity.colRange(3, 6) = 0; /* a gap between far and near */
    disparity.row(4) = 0;         /* a row without any value */
    const Scene scene = dff::load_scene(write("i.png", cv::Mat3b(5, 8)), write("d.png", disparity));
    for (int x = 0; x < 6; x++)
        EXPECT_EQ(scene.depth(2, x), 1.0F) << x;
    EXPECT_EQ(scene.depth(2, 6), 0.0F);
    EXPECT_EQ(scene.depth(4, 7), 0.0F);
    EXPECT_EQ(scene.known(2, 3), 0);
    EXPECT_EQ(scene.known(2, 2), 255);
}

TEST_F(SceneFiles, colours_come_as_red_green_blue)
{
    cv::Mat1b disparity(4, 4, uchar{10});
    disparity(0, 0) = 20;
    const Scene scene =
        dff::load_scene(write("i.png", cv::Mat3b(4, 4, cv::Vec3b(1, 2, 3))), write("d.png", disparity));
    EXPECT_EQ(scene.color(0, 0), cv::Vec3b(3, 2, 1));
}

TEST_F(SceneFiles, another_size_keeps_depths_apart)
{
    cv::Mat1b disparity(20, 20, uchar{10});
    disparity.colRange(10, 20) = 200;
    const Scene scene = dff::load_scene(write("i.png", cv::Mat3b(20, 20)), write("d.png", disparity));
    const Scene large = dff::resize_scene(scene, {47, 33});
    EXPECT_EQ(large.size(), cv::Size(47, 33));
    EXPECT_EQ(large.known.size(), large.size());
    EXPECT_EQ(cv::countNonZero(large.depth == 0.0F) + cv::countNonZero(large.depth == 1.0F), 47 * 33);
}

TEST_F(SceneFiles, a_pipe_that_nobody_writes_into_is_refused_at_once)
{
    const std::string image = write("i.png", cv::Mat3b(4, 6));
    const std::string pipe = path("pipe.png");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_NE(message_of([&] { dff::image_size(pipe); }).find("cannot be read"), std::string::npos);
    EXPECT_NE(message_of([&] { dff::load_scene(image, pipe); }).find("cannot be read"), std::string::npos);
}

TEST_F(SceneFiles, bad_files_are_named_with_what_to_do)
{
    const std::string image = write("i.png", cv::Mat3b(4, 6));
    const std::string flat = write("flat.png", cv::Mat1b(4, 6, uchar{9}));
    const std::string small = write("small.png", cv::Mat1b(4, 5, uchar{9}));
    const std::string color = write("color.png", cv::Mat3b(4, 6));
    const auto message = [&](const std::string &i, const std::string &d) {
        return message_of([&] { dff::load_scene(i, d); });
    };
    EXPECT_NE(message(path("none.png"), flat).find("none.png"), std::string::npos);
    EXPECT_NE(message(image, path("none.png")).find("depth-map"), std::string::npos);
    EXPECT_NE(message(image, small).find("5x4"), std::string::npos);
    EXPECT_NE(message(image, small).find("6x4"), std::string::npos);
    EXPECT_NE(message(image, color).find("one channel"), std::string::npos);
    EXPECT_NE(message(image, flat).find("flat"), std::string::npos);
}

TEST(Slant, falls_evenly_from_near_below_to_far_above_and_is_textured)
{
    const Scene scene = dff::make_slant({320, 241}, 0);
    EXPECT_EQ(scene.depth(0, 7), 1.0F);
    EXPECT_EQ(scene.depth(240, 7), 0.0F);
    EXPECT_NEAR(scene.depth(120, 100), 0.5, 1e-6);
    EXPECT_GT(textured_share(scene), 0.99);
}

TEST(Shapes, span_the_sweep_with_and_without_texture)
{
    const Scene scene = dff::make_shapes({640, 480}, 0);
    double nearest = 1.0;
    double farthest = 0.0;
    cv::minMaxIdx(scene.depth, &nearest, &farthest);
    EXPECT_GE(nearest, 0.0);
    EXPECT_LT(nearest, 0.1);
    EXPECT_GT(farthest, 0.8);
    EXPECT_LE(farthest, 1.0);
    EXPECT_GT(textured_share(scene), 0.75);
    EXPECT_LT(textured_share(scene), 0.97);
}

TEST(Shapes, repeat_for_a_seed_and_keep_their_places_for_another)
{
    const Scene scene = dff::make_shapes({160, 120}, 1);
    const Scene same = dff::make_shapes({160, 120}, 1);
    const Scene other = dff::make_shapes({160, 120}, 2);
    EXPECT_EQ(cv::norm(scene.color, same.color, cv::NORM_INF), 0.0);
    EXPECT_GT(cv::norm(scene.color, other.color, cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::norm(scene.depth, other.depth, cv::NORM_INF), 0.0);
}
