/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "live_objects.h"
#include "test_pipeline.h"

#include <cstdio>
#include <gtest/gtest.h>

using dff::is_sanitized;
using dff::resident_kib;
using dff::TestPipeline;

namespace {

const std::string graph =
    " ! focalstackmux ! tee name=s  s. ! queue ! dffdepth name=d ! tee name=t  t. ! queue ! c.depth  "
    "s. ! queue ! c.stack  aifcompose name=c ! queue ! appsink name=aif sync=false max-buffers=4  "
    "t. ! queue ! appsink name=depth sync=false max-buffers=4";

} // namespace

TEST(Endurance, memory_stays_flat_over_10000_frames)
{
    TestPipeline pipeline("lenssweeptestsrc planes=5 num-buffers=10000 ! video/x-raw,width=96,height=64" +
                          graph);
    pipeline.play();
    size_t stacks = 0, early = 0, late = 0;
    for (;;) {
        GstSample *depth = pipeline.pull("depth"), *aif = pipeline.pull("aif");
        EXPECT_EQ(depth == nullptr, aif == nullptr);
        if (!depth || !aif)
            break;
        gst_sample_unref(depth);
        gst_sample_unref(aif);
        stacks++;
        if (stacks == 400)
            early = resident_kib();
        if (stacks == 2000)
            late = resident_kib();
    }
    EXPECT_EQ(stacks, 2000u);
    std::printf("resident after 2000 frames %zu KiB, after 10000 frames %zu KiB\n", early, late);
    if (!is_sanitized()) {
        EXPECT_LT(late, early + 4096);
    }
}

TEST(Endurance, samples_outlive_their_pipeline)
{
    std::vector<GstSample *> kept;
    {
        TestPipeline pipeline("lenssweeptestsrc num-buffers=18 ! video/x-raw,width=96,height=64" + graph);
        pipeline.play();
        for (const char *sink : {"depth", "aif"})
            for (GstSample *sample : pipeline.pull_all(sink))
                kept.push_back(sample);
    }
    EXPECT_EQ(kept.size(), 6u);
    for (GstSample *sample : kept) {
        GstMapInfo map;
        gst_buffer_map(gst_sample_get_buffer(sample), &map, GST_MAP_READ);
        guint64 sum = 0;
        for (size_t i = 0; i < map.size; i++)
            sum += map.data[i];
        EXPECT_GT(sum, 0u);
        gst_buffer_unmap(gst_sample_get_buffer(sample), &map);
        gst_sample_unref(sample);
    }
}
