/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/bad_pixels.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace {

const cv::Size size(160, 120);
constexpr unsigned planes = 6;

/* A hot one, a dead one, and two at the border, where nothing is looked for. */
const std::vector<cv::Point> inside = {{40, 30}, {100, 80}};
const std::vector<cv::Point> at_border = {{0, 50}, {159, 119}};

/* One sweep of a texture that is sharp in plane 2, seen `shift` pixels to the side, with noise. */
std::vector<cv::Mat> sweep_of(int type, int shift, double noise, unsigned seed)
{
    cv::RNG fixed(3), random(seed);
    cv::Mat texture(size.height, size.width + 64, CV_MAKETYPE(CV_32F, CV_MAT_CN(type)));
    fixed.fill(texture, cv::RNG::UNIFORM, 30.0, 220.0);
    std::vector<cv::Mat> sweep;
    for (unsigned z = 0; z < planes; z++) {
        cv::Mat seen, grain(size, texture.type());
        const int blur = 2 * std::abs(static_cast<int>(z) - 2) + 1;
        cv::blur(texture, seen, {blur, blur});
        random.fill(grain, cv::RNG::NORMAL, 0.0, noise);
        cv::Mat picture = seen(cv::Rect({shift, 0}, size)) + grain;
        picture.convertTo(picture, type, CV_MAT_DEPTH(type) == CV_16U ? 256.0 : 1.0);
        sweep.push_back(picture);
    }
    return sweep;
}

void add_bad_pixels(std::vector<cv::Mat> &sweep)
{
    const double white = sweep.front().depth() == CV_16U ? 65535.0 : 255.0;
    for (cv::Mat &picture : sweep) {
        picture(cv::Rect(inside[0], cv::Size(1, 1))) = cv::Scalar::all(white);
        picture(cv::Rect(inside[1], cv::Size(1, 1))) = cv::Scalar::all(0.0);
        for (const cv::Point &place : at_border)
            picture(cv::Rect(place, cv::Size(1, 1))) = cv::Scalar::all(white);
    }
}

std::vector<cv::Point> told(const dff::BadPixels &known)
{
    return {known.places().begin(), known.places().end()};
}

class BadPixelTypes : public testing::TestWithParam<int> {};

} // namespace

TEST_P(BadPixelTypes, are_known_after_some_sweeps_of_a_camera_that_shakes)
{
    dff::BadPixels known;
    for (int i = 0; i < 12; i++) {
        auto sweep = sweep_of(GetParam(), 10 + 4 * i, 4.0, static_cast<unsigned>(i));
        add_bad_pixels(sweep);
        known.look(sweep);
        if (i < 2) {
            EXPECT_TRUE(known.places().empty()) << "sweep " << i;
        }
    }
    EXPECT_EQ(told(known), inside);
}

INSTANTIATE_TEST_SUITE_P(BadPixels, BadPixelTypes, testing::Values(CV_8UC1, CV_16UC1, CV_8UC3, CV_16UC4),
                         [](const auto &type) { return std::to_string(type.param); });

TEST(BadPixels, one_that_goes_bad_later_is_found_and_one_that_is_good_again_forgotten)
{
    dff::BadPixels known;
    unsigned seed = 0;
    const auto look = [&](bool bad) {
        auto sweep = sweep_of(CV_8UC1, static_cast<int>(4 * seed % 64), 4.0, seed);
        seed++;
        if (bad)
            add_bad_pixels(sweep);
        known.look(sweep);
    };
    for (int i = 0; i < 33; i++)
        look(false);
    EXPECT_TRUE(known.places().empty());
    for (int i = 0; i < 44; i++) /* the rows are searched in 32 sweeps */
        look(true);
    EXPECT_EQ(told(known), inside);
    for (int i = 0; i < 8; i++)
        look(false);
    EXPECT_TRUE(known.places().empty());
}

/* Stars, and what chroma of half the size makes of edges, may be as sharp in all planes. */
TEST(BadPixels, what_stands_still_with_the_scene_is_none_though_the_light_flickers)
{
    dff::BadPixels known;
    for (unsigned seed = 0; seed < 24; seed++) {
        auto sweep = sweep_of(CV_8UC1, 10, 4.0, seed);
        add_bad_pixels(sweep);
        for (cv::Mat &picture : sweep)
            picture *= seed % 3 == 0 ? 0.8 : 1.0;
        known.look(sweep);
        EXPECT_TRUE(known.places().empty()) << "sweep " << seed;
    }
}

/* Strong noise, whose peaks stand out from their neighbours here and there. */
TEST(BadPixels, noise_and_texture_are_none)
{
    dff::BadPixels known;
    for (unsigned seed = 0; seed < 12; seed++) {
        known.look(sweep_of(CV_8UC1, 10, 14.0, seed));
        EXPECT_TRUE(known.places().empty()) << "sweep " << seed;
    }
}

TEST(BadPixels, planes_that_show_the_same_tell_of_none)
{
    dff::BadPixels known;
    const std::vector<cv::Mat> same(planes, sweep_of(CV_8UC1, 10, 0.0, 1)[2]);
    for (int i = 0; i < 12; i++) {
        known.look(same);
        EXPECT_TRUE(known.places().empty()) << "sweep " << i;
    }
}

TEST(BadPixels, few_planes_tell_nothing)
{
    dff::BadPixels known;
    for (unsigned i = 0; i < 4; i++) {
        auto sweep = sweep_of(CV_8UC1, 10, 4.0, i);
        add_bad_pixels(sweep);
        sweep.resize(dff::BadPixels::fewest_planes - 1);
        known.look(sweep);
    }
    EXPECT_TRUE(known.places().empty());
}

TEST(BadPixels, become_the_median_of_their_neighbours)
{
    cv::Mat3b picture(4, 4, cv::Vec3b(10, 20, 30));
    picture(1, 1) = {255, 255, 255};
    picture(0, 0) = {200, 200, 200};
    const std::vector<cv::Point> places = {{1, 1}, {3, 3}};
    dff::repair_pixels(picture, places);
    EXPECT_EQ(picture(1, 1), cv::Vec3b(10, 20, 30));
    EXPECT_EQ(picture(3, 3), cv::Vec3b(10, 20, 30));
    EXPECT_EQ(picture(0, 0), cv::Vec3b(200, 200, 200));

    cv::Mat1w chroma(2, 2, 300);
    chroma(1, 1) = 999;
    dff::repair_pixels(chroma, places, 2);
    EXPECT_EQ(chroma(1, 1), 300);
}
