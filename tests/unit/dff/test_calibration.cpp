/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_pipeline.h"

#include <gtest/gtest.h>
#include <unistd.h>

using namespace dff;

namespace {

const char *const camera =
    "lenssweeptestsrc num-buffers=6 planes=6 ! video/x-raw,width=96,height=72 ! focalstackmux";

std::string write_calibration()
{
    const std::string text = "%YAML:1.0\n---\nimage_width: 192\nimage_height: 144\n"
                             "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                             "   data: [ 200., 0., 95.5, 0., 202., 71.5, 0., 0., 1. ]\n"
                             "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
                             "   data: [ 0.1, 0.2, 0.3, 0.4, 0.5 ]\n";
    return write_file("camera.yml", {text.begin(), text.end()});
}

} // namespace

TEST(Calibration, depth_tells_the_intrinsics_at_its_own_size)
{
    const std::string file = write_calibration();
    TestPipeline pipeline(std::string(camera) + " ! dffdepth calibration=" + file +
                          " ! appsink name=out sync=false");
    pipeline.play();
    GstSample *sample = pipeline.pull("out");
    ASSERT_NE(sample, nullptr);
    const GstDepthMeta *depth = gst_buffer_get_depth_meta(gst_sample_get_buffer(sample));
    EXPECT_TRUE(depth->has_intrinsics);
    EXPECT_EQ(depth->fx, 100.0);
    EXPECT_EQ(depth->fy, 101.0);
    EXPECT_EQ(depth->cx, 47.5);
    EXPECT_EQ(depth->cy, 35.5);
    EXPECT_EQ(depth->distortion[4], 0.5);
    gst_sample_unref(sample);
    unlink(file.c_str());
}

TEST(Calibration, a_missing_file_is_named)
{
    const Outcome outcome =
        run(std::string(camera) + " ! dffdepth calibration=/nonexistent.yml ! fakesink", 20);
    EXPECT_NE(outcome.error.find("/nonexistent.yml"), std::string::npos) << outcome.error;
}
