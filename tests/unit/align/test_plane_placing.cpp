/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/plane_placing.h"

#include "focalstack/lanczos_warp.h"
#include "shaken_stack.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <set>

namespace {

const cv::Size size(120, 90);

cv::Mat noisy_picture(int type, double mean)
{
    cv::Mat picture(size, type);
    cv::RNG random(5);
    random.fill(picture, cv::RNG::NORMAL, mean, 0.2 * mean);
    return picture;
}

/* Planes in their place, but for the first, which lies 20 pixels to the right. */
std::vector<dff::PlaneAlignment> first_is_moved()
{
    return {{dff::PlaneWarp(1.0, 0.0, 20.0, 0.0), true}, {{}, true}, {{}, true}};
}

double detail(const cv::Mat &picture)
{
    cv::Mat laplacian;
    cv::Laplacian(picture, laplacian, CV_32F);
    return cv::norm(laplacian, cv::NORM_L1) / static_cast<double>(laplacian.total());
}

class Types : public testing::TestWithParam<int> {};

} // namespace

TEST(UndoWarp, aligned_planes_look_like_the_middle_one)
{
    const ShakenStack stack({.planes = 4, .jitter = 3.0, .rotation = 0.01, .blur_step = 0.0});
    const auto alignments = dff::align_stack(stack.planes);
    const cv::Rect inner(10, 10, stack.size.width - 20, stack.size.height - 20);

    for (std::size_t z = 0; z < stack.planes.size(); z++) {
        cv::Mat aligned(stack.size, CV_8U);
        dff::undo_warp(stack.planes[z], aligned, alignments[z].warp);
        EXPECT_GT(cv::PSNR(aligned(inner), stack.planes[2](inner)), 33.0) << "plane " << z;
    }
}

TEST(UndoWarp, what_lies_in_its_place_is_copied)
{
    const ShakenStack stack({.planes = 2});
    cv::Mat aligned(stack.size, CV_8U);

    dff::undo_warp(stack.planes[0], aligned, {1.0, 0.0, 0.01, 0.0});
    EXPECT_EQ(cv::norm(aligned, stack.planes[0], cv::NORM_INF), 0.0);
}

TEST(UndoWarp, a_ramp_of_16_bits_keeps_its_steps)
{
    constexpr int columns = 4160, step = 15, beside = 32;
    cv::Mat plane(24, columns, CV_16UC4);
    for (int x = 0; x < columns; x++)
        plane.col(x).setTo(cv::Scalar(step * x, step * x + 100, step * x + 200, 65535));
    for (const double perspective : {0.0, 1e-9}) { /* OpenCV has a function for each */
        const dff::PlaneWarp warp(cv::Matx33d(1, 0, 2.4, 0, 1, 0.3, perspective, 0, 1));
        cv::Mat aligned(plane.size(), plane.type());
        dff::undo_warp(plane, aligned, warp);

        std::set<int> values;
        double farthest = 0.0;
        for (int x = beside; x < columns - beside; x++) {
            const auto pixel = aligned.at<cv::Vec<ushort, 4>>(12, x);
            values.insert(pixel[0]);
            for (int i = 0; i < 3; i++)
                farthest = std::max(farthest, std::abs(pixel[i] - (step * (x + 2.4) + 100.0 * i)));
            ASSERT_EQ(pixel[3], 65535);
        }
        EXPECT_LE(farthest, 1.0);
        EXPECT_EQ(values.size(), static_cast<std::size_t>(columns - 2 * beside));
    }
}

TEST(UndoWarp, small_warps_are_those_of_OpenCV_borders_included)
{
    const cv::Size large(203, 151);
    for (const int type : {CV_8UC1, CV_8UC2, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC4}) {
        const double most = CV_MAT_DEPTH(type) == CV_16U ? 65535.0 : 255.0;
        cv::Mat plane(large, type), expected, warped(large, type);
        cv::RNG random(3);
        random.fill(plane, cv::RNG::UNIFORM, 0.0, most);
        cv::GaussianBlur(plane, plane, {}, 1.2);
        cv::normalize(plane, plane, 0.0, most, cv::NORM_MINMAX);
        for (const dff::PlaneWarp &warp :
             {dff::PlaneWarp(1.0, 0.0, 3.3, -2.6), dff::PlaneWarp(1.03, 0.0, 0.5, 0.2),
              dff::PlaneWarp(0.97, 0.004, 20.0, -9.0), dff::PlaneWarp(1.0, -0.018, 0.0, 0.0),
              dff::PlaneWarp(cv::Matx33d(1, 0.001, 1.5, -0.001, 1, 2.5, 3e-5, -2e-5, 1))}) {
            const cv::Matx33d matrix = warp.pixel_matrix(large);
            cv::warpPerspective(plane, expected, matrix, large, cv::INTER_LANCZOS4 | cv::WARP_INVERSE_MAP,
                                cv::BORDER_REFLECT_101);
            ASSERT_TRUE(dff::warp_nearly_in_place(plane, warped, matrix));
            EXPECT_GT(cv::PSNR(warped, expected, most), 40.0) << "type " << type << " warp " << warp.matrix();
            EXPECT_LT(cv::norm(warped, expected, cv::NORM_INF), 0.08 * most);
        }
    }
}

TEST(UndoWarp, large_warps_are_left_to_OpenCV)
{
    cv::Mat plane(150, 200, CV_8U, cv::Scalar(7)), warped(plane.size(), CV_8U, cv::Scalar(9));
    for (const dff::PlaneWarp &warp :
         {dff::PlaneWarp(1.0, 0.05, 0.0, 0.0), dff::PlaneWarp(1.3, 0.0, 0.0, 0.0),
          dff::PlaneWarp(1.0, 0.0, 80.0, 0.0)}) {
        EXPECT_FALSE(dff::warp_nearly_in_place(plane, warped, warp.pixel_matrix(plane.size())));
        EXPECT_EQ(cv::norm(warped, cv::NORM_INF), 9.0);
        dff::undo_warp(plane, warped, warp);
        EXPECT_EQ(cv::norm(warped, cv::NORM_INF), 7.0);
        warped.setTo(9);
    }
}

/* 20 pixels of the plane's own picture are missing at its right border; in the first 5 it goes on and fades.
 * The plane is darker there than its neighbour, as beside something bright that it blurs less, and goes on
 * so. */
TEST_P(Types, what_a_plane_does_not_show_is_taken_from_its_neighbour)
{
    const cv::Mat neighbour = noisy_picture(GetParam(), 100.0);
    cv::Mat own(size, GetParam(), cv::Scalar::all(60));
    const std::vector<cv::Mat> aligned{own, neighbour, neighbour.clone()};
    dff::fill_hidden(aligned, first_is_moved());

    const cv::Mat kept = own.colRange(30, size.width - 20).rowRange(20, size.height - 20);
    EXPECT_EQ(cv::norm(kept, cv::Mat(kept.size(), kept.type(), cv::Scalar::all(60)), cv::NORM_INF), 0.0);

    const cv::Rect hidden(size.width - 15, 0, 15, size.height);
    EXPECT_NEAR(cv::mean(own(hidden))[0], 60.0, 4.0);
    EXPECT_NEAR(detail(own(hidden)) / detail(neighbour(hidden)), 1.0, 0.05);
}

INSTANTIATE_TEST_SUITE_P(FillHidden, Types,
                         testing::Values(CV_8UC1, CV_8UC2, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC4));

TEST(FillHidden, nothing_is_taken_from_a_plane_that_is_not_trusted)
{
    const cv::Mat good = noisy_picture(CV_8UC3, 100.0);
    cv::Mat wrong(size, CV_8UC3, cv::Scalar::all(255)), beyond = wrong.clone();
    const std::vector<cv::Mat> aligned{beyond, wrong, good, good.clone()};
    std::vector<dff::PlaneAlignment> alignments(4);
    alignments[2].trusted = alignments[3].trusted = true;
    dff::fill_hidden(aligned, alignments);

    EXPECT_LT(std::abs(cv::mean(wrong)[0] - cv::mean(good)[0]), 1.0);
    EXPECT_LT(detail(wrong), 0.8 * detail(good));
    EXPECT_LT(detail(beyond), 0.8 * detail(wrong)) << "further away is softer";
}

TEST(FillHidden, a_plane_without_texture_stays)
{
    cv::Mat blank(size, CV_8UC1, cv::Scalar::all(30));
    const std::vector<cv::Mat> aligned{blank, noisy_picture(CV_8UC1, 100.0)};
    std::vector<dff::PlaneAlignment> alignments(2);
    alignments[0].blank = alignments[1].trusted = true;
    dff::fill_hidden(aligned, alignments);

    EXPECT_EQ(cv::countNonZero(blank != 30), 0);
}

TEST(FillHidden, a_picture_smaller_than_the_rim_is_filled)
{
    cv::Mat own(10, 10, CV_8UC1, cv::Scalar::all(10)), neighbour(10, 10, CV_8UC1, cv::Scalar::all(90));
    neighbour.at<uchar>(9, 9) = 120;
    const std::vector<cv::Mat> aligned{own, neighbour};
    const std::vector<dff::PlaneAlignment> alignments{{dff::PlaneWarp(1.0, 0.0, 5.0, 5.0), true}, {{}, true}};
    dff::fill_hidden(aligned, alignments, 2);

    EXPECT_NEAR(own.at<uchar>(9, 9), 10 + 120 - 90, 2);
}

/* A step would be the sharpest edge that the plane has there. */
TEST(FillHidden, nothing_tells_where_a_plane_ends)
{
    cv::Mat1b own(size), neighbour(size);
    for (int y = 0; y < size.height; y++) {
        for (int x = 0; x < size.width; x++) {
            own(y, x) = cv::saturate_cast<uchar>(60.0 + 0.5 * x + 0.3 * y); /* blurred */
            neighbour(y, x) = x + y < 150 ? 30 : 200;
        }
    }
    const std::vector<cv::Mat> aligned{own, neighbour, neighbour.clone()};
    dff::fill_hidden(aligned, first_is_moved());

    for (const int x :
         {size.width - 17, size.width - 16, size.width - 15}) { /* between both, and where that ends */
        for (int y = 0; y < 30; y++)                            /* where the neighbour has no edge either */
            EXPECT_NEAR(own(y, x), own(y, x - 1), 6.0) << x << "," << y;
    }
}

TEST(FillHidden, the_border_of_breathing_planes_looks_like_the_middle_one)
{
    const ShakenStack stack({.planes = 5, .breathing = 0.2, .jitter = 0.0, .blur_step = 0.0});
    const auto alignments = dff::align_stack(stack.planes);
    std::vector<cv::Mat> aligned;
    for (std::size_t z = 0; z < stack.planes.size(); z++) {
        aligned.emplace_back(stack.size, CV_8U);
        dff::undo_warp(stack.planes[z], aligned[z], alignments[z].warp);
    }
    dff::fill_hidden(aligned, alignments);

    for (std::size_t z = 0; z < stack.planes.size(); z++)
        EXPECT_GT(cv::PSNR(aligned[z], stack.planes[2]), 24.0) << "plane " << z;
}
