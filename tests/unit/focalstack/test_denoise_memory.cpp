/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * A camera runs for days. */
#include "support.h"

#include <algorithm>
#include <fstream>
#include <gst/video/video.h>
#include <gtest/gtest.h>
#include <random>
#include <unistd.h>

namespace {

constexpr int width = 96, height = 72;
constexpr guint planes = 6;

long resident_bytes()
{
    long all = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> all >> resident;
    return resident * sysconf(_SC_PAGESIZE);
}

/* Noise, and a bright square that passes. */
GstBuffer *sweep_of(const GstFocalStackInfo &info, const std::vector<guint8> &noise, guint64 sweep)
{
    GstBuffer *stack = gst_buffer_new_memdup(noise.data(), gst_focal_stack_info_get_size(&info));
    GstMapInfo map;
    gst_buffer_map(stack, &map, GST_MAP_WRITE);
    for (guint z = 0; z < planes; z++)
        for (gsize y = 30; y < 46; y++)
            memset(map.data + (z * height + y) * width + sweep * 5 % 60 + 2 * z, 220, 12);
    gst_buffer_unmap(stack, &map);
    GST_BUFFER_PTS(stack) = sweep * 38 * GST_MSECOND;
    GST_BUFFER_DURATION(stack) = 38 * GST_MSECOND;
    return stack;
}

} // namespace

TEST(DenoiseMemory, is_flat_over_ten_thousand_sweeps_and_a_flush)
{
    GstFocalStackInfo info;
    info.planes = planes;
    info.frame = video_info("GRAY8", width, height);
    const Owned<GstHarness> harness(gst_harness_new("focalstackdenoise"));
    g_object_set(harness->element, "frames", 16U, "local-motion", TRUE, nullptr);
    gst_harness_set_src_caps(harness.get(), gst_focal_stack_info_to_caps(&info));

    std::mt19937 random(1);
    std::normal_distribution<float> level(100.0F, 5.0F);
    std::vector<guint8> noise(gst_focal_stack_info_get_size(&info));
    long settled = 0;
    for (guint64 sweep = 0; sweep < 10000; sweep++) {
        if (sweep < 1000)
            std::generate(noise.begin(), noise.end(), [&] { return static_cast<guint8>(level(random)); });
        else if (sweep == 1000)
            settled = resident_bytes();
        else if (sweep == 5000) {
            gst_harness_push_event(harness.get(), gst_event_new_flush_start());
            gst_harness_push_event(harness.get(), gst_event_new_flush_stop(TRUE));
            GstSegment segment;
            gst_segment_init(&segment, GST_FORMAT_TIME);
            gst_harness_push_event(harness.get(), gst_event_new_segment(&segment));
        }
        ASSERT_EQ(gst_harness_push(harness.get(), sweep_of(info, noise, sweep)), GST_FLOW_OK);
        const Owned<GstBuffer> stack(gst_harness_pull(harness.get()));
        ASSERT_NE(stack, nullptr);
    }
#ifndef __SANITIZE_ADDRESS__ /* which keeps what was given back */
    EXPECT_LT(resident_bytes() - settled, 4 << 20);
#endif
    EXPECT_GT(settled, 0);
}
