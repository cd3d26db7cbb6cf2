/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* Stacks of about 4 GiB and of 6, whole: run by hand (meson test --suite large --setup large), where 8 GiB
 * are to spare. What of it needs no memory is among the tests of dff::MemoryPool. */
#include "support.h"

#include <gtest/gtest.h>

namespace {

struct Size {
    const char *format;
    int width, height;
    gsize bytes; /* of 64 planes */
};

constexpr gsize gibibyte = gsize{1} << 30;
constexpr unsigned planes = 64;

} // namespace

class LargeStacks : public testing::TestWithParam<Size> {};

TEST_P(LargeStacks, leave_the_mux_whole)
{
    const Size &size = GetParam();
    const GstVideoInfo info = video_info(size.format, size.width, size.height);
    const Owned<GstHarness> harness(gst_harness_new_parse("focalstackmux"));
    gst_harness_set_src_caps_str(harness.get(), frame_caps(size.format, size.width, size.height).c_str());
    for (unsigned z = 0; z < planes; z++)
        ASSERT_EQ(gst_harness_push(harness.get(), new_frame(info, 0, z, planes)), GST_FLOW_OK);
    const Owned<GstBuffer> stack(gst_harness_try_pull(harness.get()));
    ASSERT_TRUE(stack);
    ASSERT_EQ(gst_buffer_get_size(stack.get()), size.bytes);
    GstMapInfo map;
    ASSERT_TRUE(gst_buffer_map(stack.get(), &map, GST_MAP_READ));
    const gsize frame = size.bytes / planes;
    for (unsigned z = 0; z < planes; z++)
        for (const gsize place : {gsize{0}, frame / 2, frame - 1})
            ASSERT_EQ(map.data[z * frame + place], shade(0, z)) << "plane " << z;
    gst_buffer_unmap(stack.get(), &map);
}

TEST_P(LargeStacks, come_apart_again)
{
    const Size &size = GetParam();
    const GstVideoInfo info = video_info(size.format, size.width, size.height);
    const Owned<GstHarness> harness(gst_harness_new_parse("focalstackmux ! focalstackdemux"));
    gst_harness_set_src_caps_str(harness.get(), frame_caps(size.format, size.width, size.height).c_str());
    for (unsigned z = 0; z < planes; z++)
        ASSERT_EQ(gst_harness_push(harness.get(), new_frame(info, 0, z, planes)), GST_FLOW_OK);
    for (unsigned z = 0; z < planes; z++) {
        const Owned<GstBuffer> frame(gst_harness_try_pull(harness.get()));
        ASSERT_TRUE(frame);
        guint8 last = 0;
        gst_buffer_extract(frame.get(), size.bytes / planes - 1, &last, 1);
        ASSERT_EQ(last, shade(0, z)) << "plane " << z;
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, LargeStacks,
                         testing::Values(Size{"GRAY8", 8192, 8184, 4 * gibibyte - 64 * 8192 * 8},
                                         Size{"GRAY8", 8192, 8192, 4 * gibibyte},
                                         Size{"RGB", 8192, 4096, 6 * gibibyte}));
