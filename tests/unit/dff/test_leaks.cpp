/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_pipeline.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>

using dff::TestPipeline;

namespace {

/* How many objects of each type are alive, as the leaks tracer counts them (GST_TRACERS=leaks). */
std::map<std::string, unsigned> live_objects()
{
    std::map<std::string, unsigned> count;
    GList *tracers = gst_tracing_get_active_tracers();
    for (GList *item = tracers; item; item = item->next) {
        if (!g_str_equal(G_OBJECT_TYPE_NAME(item->data), "GstLeaksTracer"))
            continue;
        GstStructure *live = nullptr;
        g_signal_emit_by_name(item->data, "get-live-objects", &live);
        const GValue *list = gst_structure_get_value(live, "live-objects-list");
        for (guint i = 0; i < gst_value_list_get_size(list); i++) {
            const GstStructure *object = gst_value_get_structure(gst_value_list_get_value(list, i));
            const GValue *value = gst_structure_get_value(object, "object");
            count[G_VALUE_TYPE_NAME(value)]++;
        }
        /* Not freed: the tracer of 1.22 lists its objects without a reference, and freeing would take one
         * away. */
    }
    g_list_free_full(tracers, gst_object_unref);
    return count;
}

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

/* What is alive beyond `before`. Streaming threads let go of their last objects a moment after the state
 * change, hence the patience. */
std::map<std::string, unsigned> left_behind(const std::map<std::string, unsigned> &before)
{
    std::map<std::string, unsigned> more;
    for (int attempt = 0; attempt < 20; attempt++) {
        g_usleep(G_USEC_PER_SEC / 4);
        more = live_objects();
        for (const auto &[type, count] : before)
            more[type] -= std::min(count, more[type]);
        std::erase_if(more, [](const auto &entry) { return entry.second == 0; });
        if (more.empty())
            break;
    }
    return more;
}

TEST(Leaks, two_hundred_starts_and_stops_leave_no_object_behind)
{
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the leak sanitizer would report the tracer's own list";
#endif
    start_and_stop(1); /* what is made once and for all: clocks, plug-ins, types */
    g_usleep(G_USEC_PER_SEC);
    const std::map<std::string, unsigned> before = live_objects();
    start_and_stop(200);
    for (const auto &[type, count] : left_behind(before))
        ADD_FAILURE() << count << " " << type << " left behind";
}

TEST(Leaks, the_tracer_would_see_a_leak)
{
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the leak sanitizer would report the tracer's own list";
#endif
    gst_init(nullptr, nullptr);
    const unsigned before = live_objects()["GstBuffer"];
    GstBuffer *leaked = gst_buffer_new();
    EXPECT_EQ(live_objects()["GstBuffer"], before + 1);
    gst_buffer_unref(leaked);
}
