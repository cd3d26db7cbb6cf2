/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/alignment_calibration.h"

#include <fstream>
#include <gst/gst.h>
#include <gtest/gtest.h>
#include <iomanip>
#include <stdexcept>
#include <unistd.h>

using namespace dff;

namespace {

class File {
public:
    explicit File(const std::string &planes,
                  const std::string &size = "image_width: 160\nimage_height: 120\n")
        : name(testing::TempDir() + "planes" + std::to_string(getpid()) + ".yml")
    {
        std::ofstream(name) << "%YAML:1.0\n---\n" << size << planes;
    }
    ~File() { unlink(name.c_str()); }

    const std::string name;
};

const std::string two_planes = "planes:\n  - { dx: 3.0, dy: -1, scale: 1.02, rotation: 90 }\n"
                               "  - { dx: 0.0, dy: 0.0, scale: 1.0, rotation: 0.0 }\n";

void expect_refused(const std::string &name, const std::string &reason)
{
    try {
        AlignmentCalibration::load(name);
        ADD_FAILURE() << "not refused";
    } catch (const std::runtime_error &error) {
        EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
}

void expect_refused(const File &file, const std::string &reason)
{
    expect_refused(file.name, reason);
}

struct Aligned {
    std::vector<guint8> bytes;
    std::string planes; /* of stats, as such a file says them */
    std::string error;
};

std::string planes_text(GstElement *align)
{
    std::ostringstream text;
    text << std::setprecision(17) << "planes:\n";
    GstStructure *stats = nullptr;
    g_object_get(align, "stats", &stats, nullptr);
    const GValue *array = gst_structure_get_value(stats, "planes");
    for (guint z = 0; z < gst_value_array_get_size(array); z++) {
        gdouble dx = 0, dy = 0, scale = 0, rotation = 0;
        gst_structure_get(gst_value_get_structure(gst_value_array_get_value(array, z)), "dx", G_TYPE_DOUBLE,
                          &dx, "dy", G_TYPE_DOUBLE, &dy, "scale", G_TYPE_DOUBLE, &scale, "rotation",
                          G_TYPE_DOUBLE, &rotation, nullptr);
        text << std::fixed << "  - { dx: " << dx << ", dy: " << dy << ", scale: " << scale
             << ", rotation: " << rotation << " }\n";
    }
    gst_structure_free(stats);
    return text.str();
}

/* A simulated sweep that breathes, aligned with these properties. */
Aligned align(const std::string &properties)
{
    gst_init(nullptr, nullptr);
    g_autoptr(GstElement) pipeline =
        gst_parse_launch(("lenssweeptestsrc num-buffers=5 planes=5 breathing=0.03 ! "
                          "video/x-raw,format=GRAY8,width=160,height=120 ! "
                          "focalstackmux ! focalstackalign name=align " +
                          properties + " ! appsink name=out sync=false")
                             .c_str(),
                         nullptr);
    g_autoptr(GstElement) element = gst_bin_get_by_name(GST_BIN(pipeline), "align");
    g_autoptr(GstElement) sink = gst_bin_get_by_name(GST_BIN(pipeline), "out");
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline);
    g_autoptr(GstSample) sample = nullptr;
    Aligned aligned;
    if (gst_element_set_state(pipeline, GST_STATE_PLAYING) != GST_STATE_CHANGE_FAILURE)
        g_signal_emit_by_name(sink, "try-pull-sample", 60 * GST_SECOND, &sample);
    if (sample) {
        GstBuffer *stack = gst_sample_get_buffer(sample);
        aligned.bytes.resize(gst_buffer_get_size(stack));
        gst_buffer_extract(stack, 0, aligned.bytes.data(), aligned.bytes.size());
        aligned.planes = planes_text(element);
    }
    g_autoptr(GstMessage) message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
    g_autoptr(GError) error = nullptr;
    if (message) {
        gst_message_parse_error(message, &error, nullptr);
        aligned.error = error->message;
    }
    gst_element_set_state(pipeline, GST_STATE_NULL);
    return aligned;
}

} // namespace

TEST(AlignmentCalibration, warps_are_for_any_size_of_the_picture)
{
    const File file(two_planes);
    const std::vector<PlaneAlignment> half = AlignmentCalibration::load(file.name).alignments({80, 60}, 2);
    ASSERT_EQ(half.size(), 2u);
    EXPECT_NEAR(half[0].warp.shift().x, 1.5, 1e-9);
    EXPECT_NEAR(half[0].warp.shift().y, -0.5, 1e-9);
    EXPECT_NEAR(half[0].warp.scale(), 1.02, 1e-9);
    EXPECT_NEAR(half[0].warp.rotation(), 90.0 * CV_PI / 180.0, 1e-9);
    EXPECT_TRUE(half[1].trusted);
}

TEST(AlignmentCalibration, a_matrix_is_a_homography_for_any_size)
{
    const File file("planes:\n  - { matrix: [ 2, 0, 6, 0, 2, -2, 0.02, 0, 2 ] }\n");
    const PlaneWarp half = AlignmentCalibration::load(file.name).alignments({80, 60}, 1).front().warp;
    EXPECT_NEAR(half.apply({0, 0}).x, 1.5, 1e-9);
    EXPECT_NEAR(half.apply({0, 0}).y, -0.5, 1e-9);
    EXPECT_NEAR(half.apply({10, 0}).x, (20.0 + 3.0) / 1.2 / 2.0, 1e-9);
}

TEST(AlignmentCalibration, what_is_wrong_with_a_file_is_told)
{
    expect_refused("/nonexistent.yml", "cannot be opened");
    expect_refused(File("planes:\n  - { dx: 1, dy: 2, rotation: 0 }\n"), "scale is missing");
    expect_refused(File(two_planes, ""), "image_width is missing");
    expect_refused(File(""), "planes must be a list");
    const auto plane = [](const std::string &entries) { return "planes:\n  - { " + entries + " }\n"; };
    expect_refused(File(plane("dx: .nan, dy: 0, scale: 1, rotation: 0")), "planes[0].dx is nan");
    expect_refused(File(plane("dx: 0, dy: 1e300, scale: 1, rotation: 0")),
                   "planes[0].dy is 1e+300 and must be");
    expect_refused(File(plane("dx: 0, dy: 0, scale: 0, rotation: 0")),
                   "planes[0].scale is 0 and must be 0.1 to 10");
    expect_refused(File(plane("dx: 0, dy: 0, scale: 1, rotation: .inf")), "planes[0].rotation is inf");
    expect_refused(File(two_planes, "image_width: 1e9\nimage_height: 120\n"), "image_width is 1000000000");
    expect_refused(File(plane("matrix: [ 1, 0, 0, 0, 1, 0 ]")), "planes[0].matrix");
    expect_refused(File(plane("matrix: [ 1, 0, 0, 0, 1, 0, 0, 0, 0 ]")), "cannot be undone");
    expect_refused(File(plane("matrix: [ 1, 0, 0, 1, 0, 0, 0, 0, 1 ]")), "cannot be undone");
    expect_refused(File("planes: 5\n"), "planes must be a list");
    expect_refused(File("planes: [ 5 ]\n"), "planes[0] has no named entries");
}

TEST(AlignmentCalibration, what_stats_told_aligns_the_same)
{
    g_autoptr(GstElementFactory) factory = nullptr;
    gst_init(nullptr, nullptr);
    factory = gst_element_factory_find("lenssweeptestsrc");
    if (!factory)
        GTEST_SKIP() << "the plug-in lenssweep is not built";
    const Aligned estimated = align("");
    ASSERT_FALSE(estimated.bytes.empty());
    const File file(estimated.planes);
    const Aligned calibrated = align("mode=calibration calibration=" + file.name);
    EXPECT_EQ(calibrated.error, "");
    EXPECT_EQ(calibrated.bytes, estimated.bytes);
}

TEST(AlignmentCalibration, another_number_of_planes_is_refused)
{
    const File file(two_planes);
    EXPECT_NE(align("mode=calibration calibration=" + file.name).error.find("2 planes and the stack has 5"),
              std::string::npos);
    EXPECT_NE(align("mode=calibration calibration=/nonexistent.yml").error.find("/nonexistent.yml"),
              std::string::npos);
}
