/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "support.h"

#include <gtest/gtest.h>
#include <random>

namespace {

constexpr unsigned planes = 3;

std::string stack_caps(const char *format, int width, int height)
{
    return std::string("video/x-focal-stack,format=") + format + ",width=" + std::to_string(width) +
           ",height=" + std::to_string(height) + ",planes=3,framerate=10/1";
}

/* Frames one after the other, no metas. */
GstBuffer *new_bare_stack(const GstVideoInfo &info, uint64_t sweep)
{
    const gsize size = GST_VIDEO_INFO_SIZE(&info);
    GstBuffer *stack = gst_buffer_new_allocate(nullptr, size * planes, nullptr);
    for (unsigned z = 0; z < planes; z++)
        gst_buffer_memset(stack, size * z, shade(sweep, z), size);
    return stack;
}

uint8_t shade_of(const GstVideoInfo &info, GstBuffer *buffer)
{
    GstVideoFrame frame;
    if (!gst_video_frame_map(&frame, &info, buffer, GST_MAP_READ))
        return 0;
    const uint8_t found = *static_cast<uint8_t *>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0));
    gst_video_frame_unmap(&frame);
    return found;
}

class Demux : public testing::Test {
protected:
    void SetUp() override
    {
        harness_.reset(gst_harness_new("focalstackdemux"));
        bus_ = gst_bus_new();
        gst_element_set_bus(harness_->element, bus_);
        gst_harness_set_src_caps_str(harness_.get(), stack_caps("I420", 32, 16).c_str());
    }

    void TearDown() override
    {
        gst_element_set_bus(harness_->element, nullptr);
        harness_.reset();
        gst_object_unref(bus_);
    }

    std::string error_text()
    {
        const Owned<GstMessage> message(gst_bus_pop_filtered(bus_, GST_MESSAGE_ERROR));
        if (!message)
            return "";
        g_autoptr(GError) error = nullptr;
        gst_message_parse_error(message.get(), &error, nullptr);
        return error->message;
    }

    Owned<GstBuffer> pull() { return Owned<GstBuffer>(gst_harness_try_pull(harness_.get())); }

    GstVideoInfo info_ = video_info("I420", 32, 16);
    Owned<GstHarness> harness_;
    GstBus *bus_ = nullptr;
};

} // namespace

TEST_F(Demux, stack_without_metas_gives_its_frames)
{
    for (uint64_t k = 0; k < 2; k++)
        ASSERT_EQ(gst_harness_push(harness_.get(), new_bare_stack(info_, k)), GST_FLOW_OK);
    for (uint64_t k = 0; k < 2; k++)
        for (unsigned z = 0; z < planes; z++) {
            const Owned<GstBuffer> frame = pull();
            ASSERT_TRUE(frame);
            EXPECT_EQ(shade_of(info_, frame.get()), shade(k, z));
            const GstFocusMeta *focus = gst_buffer_get_focus_meta(frame.get());
            ASSERT_NE(focus, nullptr);
            EXPECT_EQ(focus->sweep, k);
            EXPECT_EQ(focus->plane, z);
            EXPECT_EQ(focus->planes, planes);
            EXPECT_EQ(GST_BUFFER_PTS(frame.get()), k * GST_SECOND / 10 + z * (GST_SECOND / 10) / planes);
        }
}

TEST_F(Demux, caps_of_frames_say_frames_a_second)
{
    gst_harness_push(harness_.get(), new_bare_stack(info_, 0));
    g_autoptr(GstCaps) caps = gst_pad_get_current_caps(harness_->sinkpad);
    GstVideoInfo info;
    ASSERT_TRUE(gst_video_info_from_caps(&info, caps));
    EXPECT_EQ(GST_VIDEO_INFO_FPS_N(&info), 30);
    EXPECT_EQ(GST_VIDEO_INFO_FORMAT(&info), GST_VIDEO_FORMAT_I420);
}

TEST_F(Demux, frames_share_the_stacks_memory)
{
    GstBuffer *stack = new_bare_stack(info_, 0);
    GstMapInfo whole;
    gst_buffer_map(stack, &whole, GST_MAP_READ);
    const uint8_t *const data = whole.data;
    gst_buffer_unmap(stack, &whole);
    gst_harness_push(harness_.get(), stack);
    for (unsigned z = 0; z < planes; z++) {
        const Owned<GstBuffer> frame = pull();
        GstMapInfo part;
        gst_buffer_map(frame.get(), &part, GST_MAP_READ);
        EXPECT_EQ(part.data, data + z * GST_VIDEO_INFO_SIZE(&info_));
        EXPECT_EQ(part.size, GST_VIDEO_INFO_SIZE(&info_));
        gst_buffer_unmap(frame.get(), &part);
    }
}

TEST_F(Demux, a_bytes_segment_becomes_one_in_time)
{
    GstSegment bytes;
    gst_segment_init(&bytes, GST_FORMAT_BYTES);
    gst_harness_push_event(harness_.get(), gst_event_new_segment(&bytes));
    gst_harness_push(harness_.get(), new_bare_stack(info_, 0));
    GstEvent *event = gst_pad_get_sticky_event(harness_->sinkpad, GST_EVENT_SEGMENT, 0);
    ASSERT_NE(event, nullptr);
    const GstSegment *segment = nullptr;
    gst_event_parse_segment(event, &segment);
    EXPECT_EQ(segment->format, GST_FORMAT_TIME);
    gst_event_unref(event);
}

TEST_F(Demux, planes_that_were_missing_are_flagged)
{
    GstBuffer *stack = new_bare_stack(info_, 0);
    GstFocalStackMeta *meta = gst_buffer_add_focal_stack_meta(stack, 7, planes);
    meta->missing = 0b010;
    gst_harness_push(harness_.get(), stack);
    EXPECT_FALSE(GST_BUFFER_FLAG_IS_SET(pull().get(), GST_BUFFER_FLAG_CORRUPTED));
    EXPECT_TRUE(GST_BUFFER_FLAG_IS_SET(pull().get(), GST_BUFFER_FLAG_CORRUPTED));
    EXPECT_FALSE(GST_BUFFER_FLAG_IS_SET(pull().get(), GST_BUFFER_FLAG_CORRUPTED));
}

TEST_F(Demux, rows_may_be_padded)
{
    const gsize size = (40 * 16 + 2 * 24 * 8 + 10);
    GstBuffer *stack = gst_buffer_new_allocate(nullptr, size * planes, nullptr);
    for (unsigned z = 0; z < planes; z++) {
        gst_buffer_memset(stack, size * z, shade(1, z), size);
        gsize offset[GST_VIDEO_MAX_PLANES] = {size * z, size * z + 40 * 16, size * z + 40 * 16 + 24 * 8};
        gint stride[GST_VIDEO_MAX_PLANES] = {40, 24, 24};
        gst_buffer_add_video_meta_full(stack, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_I420, 32, 16, 3,
                                       offset, stride)
            ->id = static_cast<gint>(z);
    }
    gst_harness_push(harness_.get(), stack);
    for (unsigned z = 0; z < planes; z++) {
        const Owned<GstBuffer> frame = pull();
        GstVideoFrame picture;
        ASSERT_TRUE(gst_video_frame_map(&picture, &info_, frame.get(), GST_MAP_READ));
        EXPECT_EQ(GST_VIDEO_FRAME_PLANE_STRIDE(&picture, 1), 24);
        for (unsigned c = 0; c < 3; c++) {
            const auto *data = static_cast<uint8_t *>(GST_VIDEO_FRAME_COMP_DATA(&picture, c));
            const int last =
                GST_VIDEO_FRAME_COMP_STRIDE(&picture, c) * (GST_VIDEO_FRAME_COMP_HEIGHT(&picture, c) - 1) +
                GST_VIDEO_FRAME_COMP_WIDTH(&picture, c) - 1;
            EXPECT_EQ(data[0], shade(1, z));
            EXPECT_EQ(data[last], shade(1, z));
        }
        gst_video_frame_unmap(&picture);
    }
}

TEST_F(Demux, a_size_that_does_not_fit_is_an_error_that_names_both)
{
    GstBuffer *truncated = new_bare_stack(info_, 0);
    gst_buffer_set_size(truncated, 2000);
    EXPECT_EQ(gst_harness_push(harness_.get(), truncated), GST_FLOW_ERROR);
    const std::string text = error_text();
    EXPECT_NE(text.find("2000"), std::string::npos) << text;
    EXPECT_NE(text.find("2304"), std::string::npos) << text;
}

TEST_F(Demux, a_stack_that_is_too_long_is_an_error_too)
{
    EXPECT_EQ(gst_harness_push(harness_.get(), gst_buffer_new_allocate(nullptr, 2305, nullptr)),
              GST_FLOW_ERROR);
    const std::string text = error_text();
    EXPECT_NE(text.find("2305"), std::string::npos) << text;
    EXPECT_NE(text.find("2304"), std::string::npos) << text;
}

TEST_F(Demux, caps_of_impossible_stacks_are_refused)
{
    g_autoptr(GstCaps) single =
        gst_caps_from_string("video/x-focal-stack,format=GRAY8,width=32,height=16,planes=1,framerate=10/1");
    gst_harness_push_event(harness_.get(), gst_event_new_caps(single));
    EXPECT_EQ(gst_harness_push(harness_.get(), new_bare_stack(info_, 0)), GST_FLOW_NOT_NEGOTIATED);
}

/* Whatever the metas say, the demux sends frames that lie within the stack, or ends with an error. */
TEST_F(Demux, damaged_stacks_end_in_an_error_at_worst)
{
    unsigned refused = 0;
    for (unsigned seed = 0; seed < 3000; seed++) {
        std::mt19937 random(seed);
        const auto damaged_size = [&](gsize size) -> gsize {
            switch (random() % 6) {
            case 0:
                return random() % 4000;
            case 1:
                return G_MAXSIZE - random() % 4000;
            default:
                return size;
            }
        };
        const gsize size = random() % 4 ? 2304 : random() % 4000;
        GstBuffer *stack = gst_buffer_new_allocate(nullptr, size, nullptr);
        gst_buffer_memset(stack, 0, 1, size);
        if (random() % 2) {
            GstFocalStackMeta *meta = gst_buffer_add_focal_stack_meta(stack, random(), 2 + random() % 63);
            meta->missing = random();
            meta->repeated = random();
        }
        for (unsigned z = 0; z < planes && random() % 8; z++) {
            gsize offset[GST_VIDEO_MAX_PLANES] = {z * 768, z * 768 + 512, z * 768 + 640};
            gint stride[GST_VIDEO_MAX_PLANES] = {32, 16, 16};
            GstVideoMeta *meta = gst_buffer_add_video_meta_full(
                stack, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_I420, 32, 16, 3, offset, stride);
            meta->id = static_cast<gint>(random() % 8 ? z : random());
            if (random() % 8 == 0)
                meta->width = random() % 100;
            if (random() % 8 == 0)
                meta->format = GST_VIDEO_FORMAT_NV12;
            for (unsigned c = 0; c < 3; c++) {
                meta->offset[c] = damaged_size(meta->offset[c]);
                if (random() % 16 == 0)
                    meta->stride[c] = static_cast<gint>(random());
            }
        }

        if (gst_harness_push(harness_.get(), stack) != GST_FLOW_OK) {
            EXPECT_NE(error_text(), "") << "seed " << seed;
            refused++;
        }
        while (const Owned<GstBuffer> frame = pull()) {
            GstVideoFrame picture;
            ASSERT_TRUE(gst_video_frame_map(&picture, &info_, frame.get(), GST_MAP_READ)) << "seed " << seed;
            for (unsigned c = 0; c < 3; c++)
                for (int y = 0; y < GST_VIDEO_FRAME_COMP_HEIGHT(&picture, c); y++)
                    for (int x = 0; x < GST_VIDEO_FRAME_COMP_WIDTH(&picture, c); x++)
                        ASSERT_EQ(static_cast<uint8_t *>(GST_VIDEO_FRAME_COMP_DATA(
                                      &picture, c))[y * GST_VIDEO_FRAME_COMP_STRIDE(&picture, c) + x],
                                  1)
                            << "seed " << seed;
            gst_video_frame_unmap(&picture);
        }
    }
    EXPECT_GT(refused, 500u);
    EXPECT_LT(refused, 2900u);
}
