/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "live_objects.h"
#include "test_pipeline.h"

#include <gtest/gtest.h>

using dff::left_behind;
using dff::live_objects;
using dff::TestPipeline;

namespace {

/* Builds the whole graph, takes it from NULL to PLAYING and back `cycles` times, and lets it go. */
void start_and_stop(int cycles)
{
    TestPipeline pipeline(
        "lenssweeptestsrc ! video/x-raw,width=64,height=64 ! focalstackmux ! tee name=s  "
        "s. ! queue ! dffdepth name=d ! tee name=t  t. ! queue ! c.depth  "
        "s. ! queue ! c.stack  aifcompose name=c ! queue ! fakesink  "
        "t. ! queue ! appsink name=depth sync=false max-buffers=4  d.motion ! queue ! fakesink");
    for (int cycle = 0; cycle < cycles; cycle++) {
        pipeline.play();
        if (cycle % 10 == 0) {
            GstSample *sample = pipeline.pull("depth");
            ASSERT_NE(sample, nullptr);
            gst_sample_unref(sample);
        }
        pipeline.stop();
    }
}

} // namespace

TEST(Leaks, two_hundred_starts_and_stops_leave_no_object_behind)
{
    if (dff::is_sanitized())
        GTEST_SKIP() << "the leak sanitizer would report the tracer's own list";
    start_and_stop(1); /* what is made once and for all: clocks, plug-ins, types */
    g_usleep(G_USEC_PER_SEC);
    const std::map<std::string, unsigned> before = live_objects();
    start_and_stop(200);
    for (const auto &[type, count] : left_behind(before))
        ADD_FAILURE() << count << " " << type << " left behind";
}

TEST(Leaks, the_tracer_would_see_a_leak)
{
    if (dff::is_sanitized())
        GTEST_SKIP() << "the leak sanitizer would report the tracer's own list";
    gst_init(nullptr, nullptr);
    const unsigned before = live_objects()["GstBuffer"];
    GstBuffer *leaked = gst_buffer_new();
    EXPECT_EQ(live_objects()["GstBuffer"], before + 1);
    gst_buffer_unref(leaked);
}
