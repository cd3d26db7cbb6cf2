/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_pipeline.h"

#include <cmath>
#include <gtest/gtest.h>
#include <unistd.h>

using namespace dff;

namespace {

const char *const camera =
    "lenssweeptestsrc num-buffers=6 planes=6 ! video/x-raw,width=96,height=72 ! focalstackmux";

/* What dff-calibrate would write of a lens whose field is bent by a plane, and of nothing else. */
constexpr char focus[] =
    "focus:\n   vergences: [ 3.4, 2.86, 2.32, 1.78, 1.24, 0.7 ]\n   field: [ 0., 0., -0.54 ]\n";

std::string write_calibration(const std::string &more = "")
{
    std::string text = "%YAML:1.0\n---\nimage_width: 192\nimage_height: 144\n"
                       "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                       "   data: [ 200., 0., 95.5, 0., 202., 71.5, 0., 0., 1. ]\n"
                       "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
                       "   data: [ 0.1, 0.2, 0.3, 0.4, 0.5 ]\n";
    text += more;
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

namespace {

/* Mean error, in planes, of the depth of a slanted plane in the corners of the picture, where the lens's
 * field is bent; the plane's vergence falls evenly from the bottom of the picture to its top. */
double error_in_corners(const std::string &properties)
{
    constexpr int width = 320, height = 240;
    TestPipeline pipeline(
        "lenssweeptestsrc num-buffers=6 planes=6 near=3.4 far=0.7 scene=slant field-curvature=1 ! "
        "video/x-raw,width=320,height=240 ! focalstackmux ! dffdepth " +
        properties + " ! appsink name=out sync=false");
    pipeline.play();
    GstSample *sample = pipeline.pull("out");
    if (!sample)
        return NAN;
    GstBuffer *buffer = gst_sample_get_buffer(sample);
    const GstDepthMeta *depth = gst_buffer_get_depth_meta(buffer);
    GstMapInfo map;
    gst_buffer_map(buffer, &map, GST_MAP_READ);
    const auto *pixels = reinterpret_cast<const guint16 *>(map.data);
    double sum = 0.0;
    int count = 0;
    for (int y = 40; y < height - 60; y++)
        for (int x = 0; x < width; x++) {
            const double right = (x - 159.5) / 199.4, down = (y - 119.5) / 199.4;
            if (right * right + down * down < 0.5)
                continue;
            double value = depth->offset + depth->scale * pixels[y * width + x];
            if (depth->unit == GST_DEPTH_UNIT_MILLIMETRE)
                value = 1000.0 / value;
            sum += (0.7 + 2.7 * y / (height - 1.0) - value) / 0.54;
            count++;
        }
    gst_buffer_unmap(buffer, &map);
    gst_sample_unref(sample);
    return sum / count;
}

} // namespace

TEST(Calibration, depth_knows_the_bent_field_of_the_lens)
{
    const std::string file = write_calibration(focus);
    EXPECT_LT(error_in_corners("unit=dioptre"), -0.5); /* by so much the field moves it */
    EXPECT_LT(std::abs(error_in_corners("unit=dioptre calibration=" + file)), 0.1);
    EXPECT_LT(std::abs(error_in_corners("unit=millimetre calibration=" + file)), 0.1);
    unlink(file.c_str());
}

TEST(Calibration, millimetres_need_no_powers_of_the_stack)
{
    const std::string file = write_calibration(focus);
    TestPipeline pipeline(
        "videotestsrc num-buffers=6 pattern=smpte ! video/x-raw,width=96,height=72 ! lenssweeptag ! "
        "focalstackmux ! dffdepth unit=millimetre calibration=" +
        file + " ! appsink name=out sync=false");
    pipeline.play();
    GstSample *sample = pipeline.pull("out");
    ASSERT_NE(sample, nullptr);
    EXPECT_EQ(gst_buffer_get_depth_meta(gst_sample_get_buffer(sample))->unit, GST_DEPTH_UNIT_MILLIMETRE);
    gst_sample_unref(sample);
    unlink(file.c_str());
}

TEST(Calibration, one_of_another_sweep_is_refused)
{
    const std::string file = write_calibration(focus);
    const Outcome outcome =
        run("lenssweeptestsrc num-buffers=8 planes=8 ! video/x-raw,width=96,height=72 ! focalstackmux ! "
            "dffdepth calibration=" +
                file + " ! fakesink",
            20);
    EXPECT_NE(outcome.error.find("6 planes and the stack 8"), std::string::npos) << outcome.error;
    unlink(file.c_str());
}
