/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "board_rig.h"

#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace dff {

BoardRig::BoardRig()
    : poses_{"0,-0.01,0.33,20,8,3",       "0.03,0.02,0.33,-25,5,0",    "-0.03,-0.02,0.36,5,25,-5",
             "-0.05,0.04,0.40,10,-28,10", "0.06,-0.03,0.45,-20,-15,0", "0.08,0.07,0.52,25,20,-8",
             "-0.11,-0.07,0.60,-22,18,5", "0.14,-0.10,0.72,15,-25,0",  "-0.18,0.12,0.86,-28,-10,12",
             "0.22,0.15,1.05,24,-12,-4",  "-0.28,-0.20,1.28,-20,25,0", "0.10,0.05,1.45,28,15,6"},
      camera_(testing::TempDir() + "rig" + std::to_string(getpid()) + ".yml")
{
    std::ofstream(camera_) << "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n"
                              "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                              "   data: [ 800., 0., 319.5, 0., 800., 239.5, 0., 0., 1. ]\n"
                              "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
                              "   data: [ -0.05, 0.01, 0., 0., 0. ]\n";
}

BoardRig::~BoardRig()
{
    unlink(camera_.c_str());
}

void BoardRig::expect_found(const RigCalibration &found) const
{
    ASSERT_EQ(found.focus.vergences.size(), 6u);
    EXPECT_NEAR(found.camera.fx, 800.0, 2.4);
    EXPECT_NEAR(found.camera.fy, 800.0, 2.4);
    double most_planes = 0.0, most_px = 0.0;
    for (int z = 0; z < 6; z++) {
        for (double y = -1.0; y <= 1.0; y += 0.25)
            for (double x = -1.0; x <= 1.0; x += 0.25) {
                const cv::Point2d at(0.8 * x, 0.6 * y);
                const double truth = 3.4 - step * (z + 0.5 * at.ddot(at));
                most_planes = std::max(most_planes, std::abs(found.focus.vergence_at(z, at) - truth) / step);
            }
        const double magnification = 1.0 + 0.03 * (z - 3) / 5.0;
        for (const cv::Point2d corner :
             {cv::Point2d(-319.5, -239.5), {319.5, -239.5}, {-319.5, 239.5}, {319.5, 239.5}, {0.0, 0.0}})
            most_px =
                std::max(most_px, cv::norm(found.warps.planes[static_cast<std::size_t>(z)].apply(corner) -
                                           magnification * corner));
    }
    std::printf("focal length %.2f, %.2f of 800 px; vergences within %.3f planes, planes within %.3f px\n",
                found.camera.fx, found.camera.fy, most_planes, most_px);
    EXPECT_LT(most_planes, 0.1);
    EXPECT_LT(most_px, 0.1);
}

} // namespace dff
