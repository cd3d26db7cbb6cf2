/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/partial_stack.h"

#include <gtest/gtest.h>

using namespace dff;

/* Of a stack of exactly 4 GiB only the planes that are looked at take room. */
TEST(PartialStack, every_plane_of_four_gibibytes_is_written_in_its_place)
{
    constexpr unsigned planes = 64;
    g_autoptr(GstCaps) caps = gst_caps_from_string(
        "video/x-focal-stack,format=GRAY8,width=8192,height=8192,planes=64,framerate=1/1");
    GstFocalStackInfo info;
    ASSERT_TRUE(gst_focal_stack_info_from_caps(&info, caps));
    const gsize size = GST_VIDEO_INFO_SIZE(&info.frame);
    const BufferPtr picture(gst_buffer_new_allocate(nullptr, size, nullptr));
    gst_buffer_memset(picture.get(), 0, 7, size);
    GstVideoFrame mapped;
    ASSERT_TRUE(gst_video_frame_map(&mapped, &info.frame, picture.get(), GST_MAP_READ));

    StackPool pool(info);
    BufferPtr memory = pool.acquire();
    ASSERT_TRUE(memory);
    PartialStack stack(info, std::move(memory));
    GstFocusInfo focus;
    gst_focus_info_init(&focus);
    for (const unsigned z : {0u, planes - 1})
        EXPECT_TRUE(stack.put(z, {picture.get(), &mapped, focus, {}}));
    gst_video_frame_unmap(&mapped);

    const BufferPtr finished = stack.finish(0, 0);
    GstMapInfo map;
    ASSERT_TRUE(gst_buffer_map(finished.get(), &map, GST_MAP_READ));
    ASSERT_EQ(map.size, gsize{1} << 32);
    for (const gsize place : {gsize{0}, size - 1, (planes - 1) * size, planes * size - 1})
        EXPECT_EQ(map.data[place], 7) << place;
    gst_buffer_unmap(finished.get(), &map);
}
