/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_pipeline.h"

#include <algorithm>
#include <cstdio>
#include <gtest/gtest.h>

using dff::TestPipeline;

namespace {

std::vector<guint8> first_picture(const TestPipeline &pipeline, const char *sink)
{
    g_autoptr(GstSample) sample = pipeline.pull(sink);
    GstMapInfo map;
    gst_buffer_map(gst_sample_get_buffer(sample), &map, GST_MAP_READ);
    std::vector<guint8> bytes(map.data, map.data + map.size);
    gst_buffer_unmap(gst_sample_get_buffer(sample), &map);
    return bytes;
}

std::vector<guint8> motion_map(const std::string &motion, const std::string &entropy_bits)
{
    TestPipeline pipeline(
        "lenssweeptestsrc planes=10 num-buffers=10 motion=" + motion +
        " ! video/x-raw,width=320,height=240 ! focalstackmux ! dffdepth entropy-bits=" + entropy_bits +
        " name=d ! queue ! fakesink d.motion ! queue ! appsink name=motion sync=false");
    pipeline.play();
    return first_picture(pipeline, "motion");
}

} // namespace

/* The pixels that the moving object passes are those that differ between a sweep with and one without it,
 * taken with a lens that blurs nothing. */
std::vector<bool> passed_by_the_object(const std::string &motion)
{
    std::vector<bool> passed(320 * 240);
    const std::string sharp =
        " blur-step=0 planes=10 num-buffers=10 ! video/x-raw,width=320,height=240,format=GRAY8 "
        "! appsink name=out sync=false";
    TestPipeline pipeline("lenssweeptestsrc motion=" + motion + sharp);
    pipeline.play();
    const std::vector<guint8> first = first_picture(pipeline, "out");
    for (int plane = 1; plane < 10; plane++) {
        const std::vector<guint8> later = first_picture(pipeline, "out");
        for (size_t i = 0; i < passed.size(); i++)
            passed[i] = passed[i] || std::abs(later[i] - first[i]) > 32;
    }
    return passed;
}

TEST(Motion, the_motion_pad_finds_the_moving_object)
{
    const std::vector<bool> passed = passed_by_the_object("4");
    const std::vector<guint8> moved = motion_map("4", "2.0");
    size_t object = 0, found = 0, still = 0, alarms = 0;
    for (size_t i = 0; i < passed.size(); i++) {
        object += passed[i];
        found += passed[i] && moved[i];
        still += !passed[i];
        alarms += !passed[i] && moved[i];
    }
    ASSERT_GT(object, 500u) << "there must be something to find";
    const double recall = static_cast<double>(found) / static_cast<double>(object);
    const double false_alarms = static_cast<double>(alarms) / static_cast<double>(still);
    std::printf("recall %.1f %%, false alarms %.1f %%\n", 100 * recall, 100 * false_alarms);
    EXPECT_GT(recall, 0.3);
    EXPECT_LT(false_alarms, 0.03);
}

TEST(Motion, a_lower_threshold_finds_more)
{
    const auto count = [](const std::vector<guint8> &map) { return std::count(map.begin(), map.end(), 255); };
    EXPECT_GT(count(motion_map("4", "1.5")), count(motion_map("4", "2.0")));
}
