/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "encoded_file.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <sstream>
#include <unistd.h>

using namespace dff;

namespace {

constexpr unsigned width = 64;
constexpr unsigned height = 48;
const std::string dioptres = ",depth-unit=dioptre,depth-near=5.0,depth-far=0.0";

struct Point {
    float x, y, z;
    std::array<guint8, 3> colour;
    float uncertainty;
};

/* A reader of its own for what such a file says of itself. */
std::vector<Point> read_ply(const std::vector<guint8> &bytes)
{
    const std::string text(bytes.begin(), bytes.end());
    const std::string end = "end_header\n";
    const size_t header_size = text.find(end) + end.size();
    std::istringstream header(text.substr(0, header_size));
    EXPECT_EQ(text.substr(0, 4), "ply\n");
    size_t count = 0;
    std::string word, properties;
    while (header >> word) {
        if (word == "vertex")
            header >> count;
        if (word == "property") {
            std::string type, name;
            header >> type >> name;
            properties += type + " " + name + ";";
        }
    }
    const bool uncertain = properties.ends_with("float uncertainty;");
    EXPECT_EQ(properties, std::string("float x;float y;float z;uchar red;uchar green;uchar blue;") +
                              (uncertain ? "float uncertainty;" : ""));
    const size_t size = uncertain ? 19 : 15;
    EXPECT_EQ(bytes.size(), header_size + size * count);
    std::vector<Point> points(count);
    for (size_t k = 0; k < count && header_size + size * (k + 1) <= bytes.size(); k++) {
        const guint8 *vertex = bytes.data() + header_size + size * k;
        std::memcpy(&points[k], vertex, 12);
        std::memcpy(points[k].colour.data(), vertex + 12, 3);
        points[k].uncertainty = -1.0f;
        std::memcpy(&points[k].uncertainty, vertex + 15, size - 15);
    }
    return points;
}

std::array<guint8, 3> colour_at(unsigned x, unsigned y)
{
    return {static_cast<guint8>(x), static_cast<guint8>(y), 200};
}

/* Rows at 5 dioptres (0.2 m) to 0 (infinity); unknown in the first column. */
guint16 depth_at(unsigned x, unsigned y)
{
    return x == 0 ? 0 : static_cast<guint16>(1 + 65534 * y / (height - 1));
}

double metres_at(unsigned y)
{
    return 1.0 / (5.0 - 5.0 * static_cast<unsigned>(65534 * y / (height - 1)) / 65534.0);
}

class Calibration {
public:
    explicit Calibration(const std::string &distortion)
        : file(testing::TempDir() + "camera" + std::to_string(getpid()) + ".yml")
    {
        std::ofstream(file)
            << "%YAML:1.0\n---\nimage_width: 128\nimage_height: 96\n"
               "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
               "   data: [ 120., 0., 66.5, 0., 124., 45.5, 0., 0., 1. ]\n"
               "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n   data: [ "
            << distortion << " ]\n";
    }
    ~Calibration() { unlink(file.c_str()); }

    const std::string file;
};

/* Of that camera, at half the size. */
constexpr double fx = 60.0, fy = 62.0, cx = 33.0, cy = 22.5;

EncodedFile cloud(const std::string &properties, const std::string &caps = dioptres)
{
    return encode_file("depthplyenc " + properties, width, height, colour_frame(width, height, colour_at),
                       depth_frame(width, height, depth_at), caps);
}

} // namespace

TEST(DepthPlyEnc, every_known_pixel_is_a_point_in_metres_where_the_camera_saw_it)
{
    const Calibration calibration("-0.2, 0.05, 0.001, -0.002, 0.01");
    const EncodedFile file = cloud("calibration=" + calibration.file);
    ASSERT_EQ(file.error, "");
    const std::vector<Point> points = read_ply(file.bytes);
    ASSERT_EQ(points.size(), (width - 1) * (height - 1)); /* the last row is at infinity */
    const cv::Matx33d matrix(fx, 0, cx, 0, fy, cy, 0, 0, 1);
    const std::vector<double> distortion{-0.2, 0.05, 0.001, -0.002, 0.01};
    for (const Point &point : points) {
        const unsigned x = point.colour[0], y = point.colour[1];
        EXPECT_EQ(point.colour[2], 200);
        EXPECT_NEAR(point.z, metres_at(y), 1e-4 * metres_at(y));
        std::vector<cv::Point2d> seen;
        cv::projectPoints(std::vector{cv::Point3d(point.x, point.y, point.z)}, cv::Vec3d(), cv::Vec3d(),
                          matrix, distortion, seen);
        EXPECT_NEAR(seen[0].x, x, 0.01);
        EXPECT_NEAR(seen[0].y, y, 0.01);
    }
}

TEST(DepthPlyEnc, each_point_may_tell_how_uncertain_it_is)
{
    const Calibration calibration("0., 0., 0., 0., 0.");
    const PixelAt deviation_at = [](unsigned x, unsigned) {
        return static_cast<guint16>(x == 9 ? 0 : 30 + x);
    };
    const EncodedFile file =
        encode_file("depthplyenc calibration=" + calibration.file, width, height,
                    colour_frame(width, height, colour_at), depth_frame(width, height, depth_at), dioptres,
                    {.uncertainty = depth_frame(width, height, deviation_at)});
    ASSERT_EQ(file.error, "");
    const std::vector<Point> points = read_ply(file.bytes);
    ASSERT_EQ(points.size(), (width - 1) * (height - 1));
    for (const Point &point : points) {
        const unsigned x = point.colour[0];
        const double metres = 5.0 / 65534 * (30 + x) * point.z * point.z; /* z is 1 / power */
        if (x == 9)
            EXPECT_TRUE(std::isnan(point.uncertainty));
        else
            EXPECT_NEAR(point.uncertainty, metres, 1e-4 * metres);
    }
}

TEST(DepthPlyEnc, x_points_right_and_y_down)
{
    const Calibration calibration("0, 0, 0, 0, 0");
    for (const Point &point : read_ply(cloud("calibration=" + calibration.file).bytes)) {
        EXPECT_NEAR(point.x, (point.colour[0] - cx) / fx * point.z, 1e-4 * point.z);
        EXPECT_NEAR(point.y, (point.colour[1] - cy) / fy * point.z, 1e-4 * point.z);
    }
}

TEST(DepthPlyEnc, stride_and_max_distance_leave_points_out)
{
    const Calibration calibration("0, 0, 0, 0, 0");
    const std::vector<Point> points =
        read_ply(cloud("calibration=" + calibration.file + " stride=5 max-distance=0.5").bytes);
    EXPECT_EQ(points.size(), 12u * 6u); /* x = 5, 10 ... 60; y = 0, 5 ... 25 */
    for (const Point &point : points) {
        EXPECT_EQ(point.colour[0] % 5, 0);
        EXPECT_EQ(point.colour[1] % 5, 0);
        EXPECT_LE(point.z, 0.5f);
    }
}

TEST(DepthPlyEnc, what_is_missing_is_told)
{
    const Calibration calibration("0, 0, 0, 0, 0");
    EXPECT_NE(cloud("").error.find("set calibration"), std::string::npos);
    EXPECT_NE(cloud("calibration=/nonexistent.yml").error.find("/nonexistent.yml"), std::string::npos);
    EXPECT_NE(cloud("calibration=" + calibration.file, ",depth-unit=index").error.find("plane numbers"),
              std::string::npos);
}

namespace {

/* Stage positions that rise from -10 um in the first row to 37 um in the last, or fall from there. */
EncodedFile stage_cloud(const std::string &properties, bool falling)
{
    Buffer depth = depth_frame(width, height, depth_at);
    GstDepthInfo info;
    gst_depth_info_init(&info);
    info.unit = GST_DEPTH_UNIT_MICROMETRE;
    info.scale = (falling ? -47.0 : 47.0) / 65534.0;
    info.offset = (falling ? 37.0 : -10.0) - info.scale;
    gst_buffer_add_depth_meta(depth.get(), &info);
    return encode_file("depthplyenc " + properties, width, height, colour_frame(width, height, colour_at),
                       std::move(depth), "");
}

} // namespace

TEST(DepthPlyEnc, a_microscope_sees_the_same_size_at_every_height)
{
    const EncodedFile file = stage_cloud("projection=orthographic pixel-size=0.65", false);
    ASSERT_EQ(file.error, "");
    const std::string text(file.bytes.begin(), file.bytes.end());
    EXPECT_NE(text.find("comment micrometres;"), std::string::npos);
    const std::vector<Point> points = read_ply(file.bytes);
    ASSERT_EQ(points.size(), (width - 1) * height);
    for (const Point &point : points) {
        EXPECT_NEAR(point.x, (point.colour[0] - 31.5) * 0.65, 1e-4);
        EXPECT_NEAR(point.y, (point.colour[1] - 23.5) * 0.65, 1e-4);
        EXPECT_NEAR(point.z, -10.0 + point.colour[1], 2e-3);
    }
}

TEST(DepthPlyEnc, z_points_away_from_a_microscope_whose_stage_counts_down)
{
    const EncodedFile file = stage_cloud("projection=orthographic pixel-size=2 stride=4", true);
    ASSERT_EQ(file.error, "");
    const std::vector<Point> points = read_ply(file.bytes);
    ASSERT_EQ(points.size(), 15u * 12u);
    for (const Point &point : points)
        EXPECT_NEAR(point.z, -37.0 + point.colour[1], 2e-3);
}

TEST(DepthPlyEnc, a_microscope_without_size_or_heights_is_told_what_to_give)
{
    EXPECT_NE(stage_cloud("projection=orthographic", false).error.find("needs pixel-size"),
              std::string::npos);
    EXPECT_NE(cloud("projection=orthographic pixel-size=1", ",depth-unit=index").error.find("step-um"),
              std::string::npos);
    EXPECT_NE(stage_cloud("", false).error.find("stage positions"), std::string::npos);
}

TEST(DepthPlyEnc, pictures_whose_layout_lies_are_refused)
{
    const GLogLevelFlags fatal =
        g_log_set_always_fatal(static_cast<GLogLevelFlags>(G_LOG_FATAL_MASK | G_LOG_LEVEL_CRITICAL));
    const Calibration calibration("0, 0, 0, 0, 0");
    const auto lies = std::to_array<void (*)(GstVideoMeta *)>({
        [](GstVideoMeta *meta) { meta->stride[0] = G_MAXINT; },
        [](GstVideoMeta *meta) { meta->offset[0] = 1; },
        [](GstVideoMeta *meta) { meta->width *= 2; },
        [](GstVideoMeta *meta) { meta->height /= 2; },
        [](GstVideoMeta *meta) { meta->format = GST_VIDEO_FORMAT_GRAY8; },
    });
    for (const auto lie : lies)
        for (const bool of_colour : {true, false}) {
            Buffer colour = colour_frame(width, height, colour_at);
            Buffer depth = depth_frame(width, height, depth_at);
            lie(of_colour ? gst_buffer_add_video_meta(colour.get(), GST_VIDEO_FRAME_FLAG_NONE,
                                                      GST_VIDEO_FORMAT_RGB, width, height)
                          : gst_buffer_add_video_meta(depth.get(), GST_VIDEO_FRAME_FLAG_NONE,
                                                      GST_VIDEO_FORMAT_GRAY16_LE, width, height));
            const EncodedFile file = encode_file("depthplyenc calibration=" + calibration.file, width, height,
                                                 std::move(colour), std::move(depth), dioptres);
            EXPECT_NE(file.error.find("does not hold the picture its caps describe"), std::string::npos)
                << file.error;
        }
    g_log_set_always_fatal(fatal);
}

TEST(DepthPlyEnc, pictures_of_two_sizes_are_refused_by_name)
{
    g_autoptr(GstElement) pipeline = gst_parse_launch(
        "videotestsrc num-buffers=1 ! video/x-raw,format=RGB,width=64,height=48 ! e.color "
        "videotestsrc num-buffers=1 ! video/x-raw,format=GRAY16_LE,width=32,height=48 ! e.depth "
        "depthplyenc name=e ! fakesink",
        nullptr);
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline);
    g_autoptr(GstMessage) message = gst_bus_timed_pop_filtered(
        bus, 20 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS));
    ASSERT_NE(message, nullptr);
    ASSERT_EQ(GST_MESSAGE_TYPE(message), GST_MESSAGE_ERROR);
    g_autoptr(GError) error = nullptr;
    gst_message_parse_error(message, &error, nullptr);
    EXPECT_NE(std::string(error->message).find("color is 64x48 and depth is 32x48"), std::string::npos)
        << error->message;
    gst_element_set_state(pipeline, GST_STATE_NULL);
}
