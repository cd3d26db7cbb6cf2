/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/scene_anchor.h"

#include "shaken_stack.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

using namespace dff;

namespace {

/* A part of a textured scene, seen through a warp about its centre that says where what it shows lies. */
class View {
public:
    explicit View(cv::Size size) : size_(size)
    {
        scene_ =
            ShakenStack({.size = {640, 480}, .planes = 2, .breathing = 0.0, .jitter = 0.0, .blur_step = 0.0})
                .planes.front();
    }

    cv::Mat operator()(const PlaneWarp &warp) const
    {
        const cv::Matx33d from_centre(1, 0, -(size_.width - 1) / 2.0, 0, 1, -(size_.height - 1) / 2.0, 0, 0,
                                      1);
        const cv::Matx33d to_scene(1, 0, (scene_.cols - 1) / 2.0, 0, 1, (scene_.rows - 1) / 2.0, 0, 0, 1);
        cv::Mat picture;
        cv::warpPerspective(scene_, picture, to_scene * warp.matrix() * from_centre, size_,
                            cv::INTER_CUBIC | cv::WARP_INVERSE_MAP);
        return picture;
    }

    cv::Mat operator()(double x, double y, double turn = 0.0) const
    {
        return (*this)(PlaneWarp(std::cos(turn), std::sin(turn), x, y));
    }

private:
    cv::Size size_;
    cv::Mat scene_;
};

} // namespace

TEST(SceneAnchor, whole_pixels_are_told_and_the_rest_is_given)
{
    const View view({320, 240});
    SceneAnchor anchor;
    EXPECT_EQ(anchor.rest_of(view(0, 0)).largest_shift({320, 240}), 0.0);
    for (const auto &[x, y] : {std::pair(5.3, -8.8), {-20.4, 11.0}, {0.2, 0.1}, {40.0, -31.6}}) {
        const PlaneWarp rest = anchor.rest_of(view(x, y));
        EXPECT_EQ(anchor.anchors(), 1U);
        EXPECT_EQ(anchor.shift().x % 2, 0);
        EXPECT_EQ(anchor.shift().y % 2, 0);
        EXPECT_NEAR(anchor.shift().x - rest.shift().x, x, 0.1);
        EXPECT_NEAR(anchor.shift().y - rest.shift().y, y, 0.1);
        EXPECT_LE(rest.largest_shift({320, 240}), 2.5);
    }
}

TEST(SceneAnchor, a_small_turn_belongs_to_the_rest)
{
    const View view({320, 240});
    SceneAnchor anchor;
    anchor.rest_of(view(0, 0));
    const PlaneWarp rest = anchor.rest_of(view(3.0, 4.0, 0.006));
    EXPECT_EQ(anchor.anchors(), 1U);
    EXPECT_NEAR(rest.rotation(), -0.006, 0.0006);
}

/* What shakes by less than that is told to stand still. */
TEST(SceneAnchor, a_shift_that_would_change_to_and_fro_stays)
{
    const View view({320, 240});
    SceneAnchor anchor;
    anchor.rest_of(view(0, 0));
    for (const double x : {1.1, 0.8, 1.3, -1.2}) {
        anchor.rest_of(view(x, 0.0));
        EXPECT_EQ(anchor.shift(), cv::Point());
    }
}

TEST(SceneAnchor, what_has_turned_left_or_changed_becomes_the_anchor)
{
    const View view({320, 240});
    SceneAnchor anchor;
    unsigned anchors = 0;
    const cv::Mat blank(240, 320, CV_8U, cv::Scalar(99));
    for (const cv::Mat &picture : {view(0, 0), view(0, 0, 0.1), view(110, 0, 0.1), blank, view(0, 0),
                                   view(0, 0)(cv::Rect(0, 0, 300, 200)).clone()}) {
        EXPECT_EQ(anchor.rest_of(picture).largest_shift(picture.size()), 0.0);
        EXPECT_EQ(anchor.shift(), cv::Point());
        EXPECT_EQ(anchor.anchors(), ++anchors);
    }
}
