/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* The simulated rig, measured by pictures alone. */
#include "board_collector.h"
#include "calibration_file.h"
#include "focalstack/alignment_calibration.h"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

using namespace dff;

namespace {

const Board board{10, 7, 20.0};

/* Tells what BoardCollector tells. */
struct Seen {
    std::vector<BoardView> views;
    std::string told;
    std::vector<cv::Point> bad_pixels;
};

class Rig : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        camera = testing::TempDir() + "rig" + std::to_string(getpid()) + ".yml";
        std::ofstream(camera)
            << "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n"
               "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
               "   data: [ 800., 0., 319.5, 0., 800., 239.5, 0., 0., 1. ]\n"
               "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
               "   data: [ -0.05, 0.01, 0., 0., 0. ]\n";
    }
    static void TearDownTestSuite() { unlink(camera.c_str()); }

    static Seen
    look(const std::vector<std::string> &poses, const Board &asked = board,
         const std::string &more = "breathing=0.03 field-curvature=0.5 vignetting=0.05 noise=moderate")
    {
        Seen seen;
        BoardCollector collector(asked, [&](const std::string &line) { seen.told += line + "\n"; });
        for (const std::string &pose : poses) {
            SweepReader reader(
                "lenssweeptestsrc num-buffers=6 planes=6 near=3.4 far=0.7 scene=board board=10x7x20 "
                "calibration=" +
                camera + " pose=" + pose + " " + more);
            while (const auto sweep = reader.next())
                collector.add(*sweep);
            collector.end_source();
        }
        seen.views = collector.views();
        seen.bad_pixels = collector.bad_pixels();
        return seen;
    }

    static inline std::string camera;
};

const std::vector<std::string> good_poses{
    "0,-0.01,0.33,20,8,3",       "0.03,0.02,0.33,-25,5,0",    "-0.03,-0.02,0.36,5,25,-5",
    "-0.05,0.04,0.40,10,-28,10", "0.06,-0.03,0.45,-20,-15,0", "0.08,0.07,0.52,25,20,-8",
    "-0.11,-0.07,0.60,-22,18,5", "0.14,-0.10,0.72,15,-25,0",  "-0.18,0.12,0.86,-28,-10,12",
    "0.22,0.15,1.05,24,-12,-4",  "-0.28,-0.20,1.28,-20,25,0", "0.10,0.05,1.45,28,15,6"};

} // namespace

TEST_F(Rig, twelve_boards_tell_what_the_lens_is)
{
    const Seen seen = look(good_poses);
    ASSERT_EQ(seen.views.size(), 12u) << seen.told;
    const RigCalibration found = calibrate(board, seen.views);
    const double step = 0.54;
    EXPECT_NEAR(found.camera.fx, 800.0, 2.4);
    EXPECT_NEAR(found.camera.fy, 800.0, 2.4);
    for (int z = 0; z < 6; z++) {
        for (const double radius : {0.0, 0.5, 1.0}) {
            const double truth = 3.4 - step * (z + 0.5 * radius * radius);
            EXPECT_NEAR(found.focus.vergence_at(z, {0.8 * radius, 0.6 * radius}), truth, 0.1 * step)
                << z << radius;
        }
        const double magnification = 1.0 + 0.03 * (z - 3) / 5.0;
        for (const cv::Point2d corner : {cv::Point2d(-319.5, -239.5), {319.5, 239.5}, {0.0, 0.0}})
            EXPECT_LT(cv::norm(found.warps.planes[static_cast<std::size_t>(z)].apply(corner) -
                               magnification * corner),
                      0.1);
    }

    /* The camera draws a disk of 2 px by the share of each pixel, which is as wide as one of 2.54 px. */
    EXPECT_NEAR(found.blur_step, 2.54, 0.15);
    ASSERT_EQ(found.light.planes.size(), 6u);
    for (const PlaneLight &plane : found.light.planes) {
        EXPECT_NEAR(plane.gain, 1.0, 0.002);
        EXPECT_NEAR(plane.vignetting, 0.05, 0.01);
    }
    ASSERT_TRUE(found.noise.is_known);
    /* Three colours have noise of their own, which gray mixes; both are rounded. */
    const double mixed = 0.299 * 0.299 + 0.587 * 0.587 + 0.114 * 0.114, rounding = 1.0 / 12.0;
    EXPECT_NEAR(found.noise.slope, mixed * 0.2, 0.01);
    EXPECT_NEAR(found.noise.offset, mixed * (4.0 + rounding) + rounding, 0.5);
    EXPECT_TRUE(seen.bad_pixels.empty());

    const std::string file = testing::TempDir() + "found" + std::to_string(getpid()) + ".yml";
    write_calibration(file, found, board);
    const auto warps = AlignmentCalibration::load(file).alignments({640, 480}, 6);
    EXPECT_NEAR(warps[0].warp.scale(), 1.0 - 0.018, 3e-4);
    unlink(file.c_str());

    const std::vector<std::string> few(good_poses.begin() + 3, good_poses.begin() + 6);
    EXPECT_TRUE(check(found, board, look(few).views).faults.empty());
    EXPECT_FALSE(check(found, board, look(few, board, "breathing=0.02 noise=moderate").views).faults.empty());
}

TEST_F(Rig, a_board_that_cannot_be_used_is_told)
{
    const std::string cut = look({"0.2,0,0.5,20,0,0"}, board, "noise=moderate").told;
    EXPECT_NE(cut.find("cut off"), std::string::npos) << cut;
    for (const Board &wrong : {Board{8, 6, 20.0}, Board{9, 7, 20.0}, Board{12, 9, 20.0}}) {
        const Seen seen = look({"0,0,0.5,20,0,0"}, wrong, "noise=moderate");
        EXPECT_TRUE(seen.views.empty());
        EXPECT_NE(seen.told.find("another number of squares"), std::string::npos) << seen.told;
    }
    const std::string blurred = look({"0,0,0.33,0,0,0"}, board, "near=0.9 far=0.7 blur-step=4").told;
    EXPECT_TRUE(blurred.find("blurred") != std::string::npos ||
                blurred.find("range that the sweep") != std::string::npos)
        << blurred;
}

TEST_F(Rig, frames_that_say_no_plane_are_told)
{
    SweepReader reader("videotestsrc num-buffers=2");
    try {
        reader.next();
        FAIL();
    } catch (const std::runtime_error &error) {
        EXPECT_NE(std::string(error.what()).find("lenssweeptag"), std::string::npos);
    }
    EXPECT_THROW(SweepReader("nosuchelement"), std::runtime_error);
}
