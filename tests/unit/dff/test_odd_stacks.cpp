/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* Stacks as nobody should send them, between good ones. */
#include "test_pipeline.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gst/check/gstharness.h>
#include <gst/video/video.h>
#include <gtest/gtest.h>
#include <memory>
#include <optional>

using dff::gray_stack;

namespace {

struct Deleter {
    void operator()(GstBuffer *buffer) const { gst_buffer_unref(buffer); }
    void operator()(GstHarness *harness) const { gst_harness_teardown(harness); }
};
template <typename T> using Owned = std::unique_ptr<T, Deleter>;

constexpr unsigned width = 64, height = 64, planes = 3;

std::string stack_caps(int w = width, int h = height)
{
    return "video/x-focal-stack,format=GRAY8,width=" + std::to_string(w) + ",height=" + std::to_string(h) +
           ",planes=3,framerate=10/1";
}

GstBuffer *bare_stack(unsigned sharp = 1)
{
    const std::vector<guint8> bytes = gray_stack(width, height, planes, sharp);
    return gst_buffer_new_memdup(bytes.data(), bytes.size());
}

/* `told`: planes that its meta speaks of. */
GstBuffer *new_stack(unsigned k, uint64_t sequence, unsigned told = planes, double nearest = 3.0)
{
    GstBuffer *stack = bare_stack();
    GST_BUFFER_PTS(stack) = k * GST_SECOND / 10;
    GstFocalStackMeta *meta = gst_buffer_add_focal_stack_meta(stack, sequence, told);
    for (unsigned z = 0; z < told; z++) {
        GstFocusInfo focus;
        gst_focus_info_init(&focus);
        focus.sweep = sequence;
        focus.plane = z;
        focus.planes = told;
        focus.power = z == 0 ? nearest : nearest - z;
        if (std::isinf(nearest))
            focus.power = z == 0 ? nearest : 3.0 - z;
        gst_focal_stack_meta_set_focus(meta, z, &focus);
    }
    return stack;
}

GstBuffer *new_depth(unsigned k, uint64_t sequence, guint16 pixel = 0x4000)
{
    const std::vector<guint16> pixels(width * height, pixel);
    GstBuffer *depth = gst_buffer_new_memdup(pixels.data(), pixels.size() * sizeof(guint16));
    GST_BUFFER_PTS(depth) = k * GST_SECOND / 10;
    GstDepthInfo info;
    gst_depth_info_init(&info);
    info.unit = GST_DEPTH_UNIT_DIOPTRE;
    info.near = 3.0;
    info.far = 1.0;
    info.scale = -2.0 / 65534;
    info.offset = 3.0 - info.scale;
    info.sequence = sequence;
    gst_buffer_add_depth_meta(depth, &info);
    return depth;
}

class OddStacks : public testing::Test {
protected:
    static void SetUpTestSuite() { gst_init(nullptr, nullptr); }

    void start(const char *element)
    {
        harness_.reset(gst_harness_new_parse(element));
        listen();
        gst_harness_set_src_caps_str(harness_.get(), stack_caps().c_str());
    }

    void listen()
    {
        bus_ = gst_bus_new();
        gst_element_set_bus(harness_->element, bus_);
    }

    void TearDown() override
    {
        gst_element_set_bus(harness_->element, nullptr);
        harness_.reset();
        gst_object_unref(bus_);
    }

    GstFlowReturn push(GstBuffer *stack) { return gst_harness_push(harness_.get(), stack); }
    Owned<GstBuffer> pull() { return Owned<GstBuffer>(gst_harness_pull(harness_.get())); }

    /* Takes all messages. */
    void look()
    {
        errors_.clear();
        warnings_.clear();
        while (GstMessage *message = gst_bus_pop(bus_)) {
            g_autoptr(GError) error = nullptr;
            if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
                gst_message_parse_error(message, &error, nullptr);
                errors_.emplace_back(error->message);
            } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_WARNING) {
                gst_message_parse_warning(message, &error, nullptr);
                warnings_.emplace_back(error->message);
            }
            gst_message_unref(message);
        }
    }

    void expect_blank(GstBuffer *depth)
    {
        GstMapInfo map;
        ASSERT_TRUE(gst_buffer_map(depth, &map, GST_MAP_READ));
        for (gsize i = 0; i < map.size; i++)
            ASSERT_EQ(map.data[i], 0);
        gst_buffer_unmap(depth, &map);
        EXPECT_TRUE(GST_BUFFER_FLAG_IS_SET(depth, GST_BUFFER_FLAG_GAP));
        EXPECT_TRUE(GST_BUFFER_FLAG_IS_SET(depth, GST_BUFFER_FLAG_CORRUPTED));
    }

    Owned<GstHarness> harness_;
    std::vector<std::string> errors_, warnings_;
    GstBus *bus_ = nullptr;
};

} // namespace

TEST_F(OddStacks, one_with_an_impossible_meta_has_a_depth_map_of_zeros)
{
    start("dffdepth");
    const std::vector<std::function<GstBuffer *(unsigned)>> odd{
        [](unsigned k) { return new_stack(k, k, planes, HUGE_VAL); },
        [](unsigned k) { return new_stack(k, k, planes, 1e300); },
        [](unsigned k) { return new_stack(k, k, 64); }, [](unsigned k) { return new_stack(k, k, 2); },
        [](unsigned k) {
            GstBuffer *stack = new_stack(k, k); /* rises */
            GstFocusInfo focus;
            GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(stack);
            gst_focal_stack_meta_get_focus(meta, 2, &focus);
            focus.power = 9.0;
            gst_focal_stack_meta_set_focus(meta, 2, &focus);
            return stack;
        }};
    unsigned k = 0;
    for (const auto &make : odd) {
        for (unsigned copies = 0; copies < 3; copies++, k++) {
            ASSERT_EQ(push(make(k)), GST_FLOW_OK);
            const Owned<GstBuffer> depth = pull();
            expect_blank(depth.get());
            EXPECT_EQ(gst_buffer_get_depth_meta(depth.get())->sequence, k);
            EXPECT_EQ(GST_BUFFER_PTS(depth.get()), k * GST_SECOND / 10);
        }
        ASSERT_EQ(push(new_stack(k, k)), GST_FLOW_OK);
        const Owned<GstBuffer> depth = pull();
        EXPECT_FALSE(GST_BUFFER_FLAG_IS_SET(depth.get(), GST_BUFFER_FLAG_GAP));
        EXPECT_EQ(gst_buffer_get_depth_meta(depth.get())->unit, GST_DEPTH_UNIT_DIOPTRE);
        k++;
    }
    look();
    EXPECT_TRUE(errors_.empty());
    EXPECT_GE(warnings_.size(), odd.size());
}

TEST_F(OddStacks, a_cause_is_told_once)
{
    start("dffdepth");
    for (unsigned k = 0; k < 5; k++) {
        push(new_stack(k, 0, 64));
        pull();
    }
    look();
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_.front().find("64 planes, but its caps of 3"), std::string::npos) << warnings_.front();
}

TEST_F(OddStacks, a_unit_nobody_can_have_is_an_error)
{
    start("dffdepth unit=dioptre");
    EXPECT_EQ(push(bare_stack()), GST_FLOW_ERROR);
    look();
    EXPECT_EQ(errors_.size(), 1u);
}

TEST_F(OddStacks, a_unit_that_one_stack_cannot_have_costs_that_one)
{
    start("dffdepth unit=dioptre");
    ASSERT_EQ(push(new_stack(0, 0)), GST_FLOW_OK);
    ASSERT_EQ(push(bare_stack()), GST_FLOW_OK);
    ASSERT_EQ(push(new_stack(2, 2)), GST_FLOW_OK);
    EXPECT_FALSE(GST_BUFFER_FLAG_IS_SET(pull().get(), GST_BUFFER_FLAG_GAP));
    expect_blank(pull().get());
    EXPECT_FALSE(GST_BUFFER_FLAG_IS_SET(pull().get(), GST_BUFFER_FLAG_GAP));
}

TEST_F(OddStacks, pictures_of_a_wrong_size_are_told_with_size_and_limit)
{
    for (const auto &[w, h] : {std::pair(32, 64), {64, 63}, {17000, 64}, {64, 16385}}) {
        start("dffdepth");
        gst_harness_set_src_caps_str(harness_.get(), stack_caps(w, h).c_str());
        look();
        ASSERT_FALSE(errors_.empty()) << w << "x" << h;
        for (const std::string &word :
             {std::to_string(w) + "x" + std::to_string(h), std::string("64x64 to 16384x16384")})
            EXPECT_NE(errors_.front().find(word), std::string::npos) << errors_.front();
        TearDown();
    }
    start("dffdepth");
}

TEST_F(OddStacks, short_ones_and_lying_layouts_end_the_stream_with_both_sizes)
{
    const std::vector<std::function<void(GstBuffer *, GstVideoMeta *)>> faults{
        [](GstBuffer *stack, GstVideoMeta *) { gst_buffer_set_size(stack, 3 * 64 * 64 - 1); },
        [](GstBuffer *stack, GstVideoMeta *) { gst_buffer_set_size(stack, 0); },
        [](GstBuffer *, GstVideoMeta *meta) { meta->offset[0] = 2 * 64 * 64 + 1; },
        [](GstBuffer *, GstVideoMeta *meta) { meta->offset[0] = G_MAXSIZE - 100; },
        [](GstBuffer *, GstVideoMeta *meta) { meta->stride[0] = G_MAXINT; },
        [](GstBuffer *, GstVideoMeta *meta) { meta->stride[0] = -64; },
        [](GstBuffer *, GstVideoMeta *meta) { meta->stride[0] = 63; },
        [](GstBuffer *, GstVideoMeta *meta) { meta->id = 9; },
        [](GstBuffer *, GstVideoMeta *meta) { meta->height = 65; }};
    for (size_t i = 0; i < faults.size(); i++) {
        start("dffdepth");
        GstBuffer *stack = bare_stack();
        GstFocalStackInfo info;
        g_autoptr(GstCaps) caps = gst_caps_from_string(stack_caps().c_str());
        ASSERT_TRUE(gst_focal_stack_info_from_caps(&info, caps));
        gst_focal_stack_info_add_video_metas(&info, stack);
        faults[i](stack, gst_buffer_get_video_meta_id(stack, 2));
        EXPECT_EQ(push(stack), GST_FLOW_ERROR) << "fault " << i;
        look();
        EXPECT_EQ(errors_.size(), 1u) << "fault " << i;
        TearDown();
    }
    start("dffdepth");
}

TEST_F(OddStacks, planes_may_lie_in_any_order_and_over_each_other)
{
    start("dffdepth unit=index");
    GstBuffer *stack = bare_stack(0);
    GstFocalStackInfo info;
    g_autoptr(GstCaps) caps = gst_caps_from_string(stack_caps().c_str());
    ASSERT_TRUE(gst_focal_stack_info_from_caps(&info, caps));
    gst_focal_stack_info_add_video_metas(&info, stack);
    GstVideoMeta *first = gst_buffer_get_video_meta_id(stack, 0),
                 *last = gst_buffer_get_video_meta_id(stack, 2);
    std::swap(first->id, last->id);
    gst_buffer_get_video_meta_id(stack, 1)->offset[0] = 100 * 64;
    ASSERT_EQ(push(stack), GST_FLOW_OK);
    const Owned<GstBuffer> depth = pull();
    GstMapInfo map;
    ASSERT_TRUE(gst_buffer_map(depth.get(), &map, GST_MAP_READ));
    EXPECT_GT(GST_READ_UINT16_LE(map.data + (32 * 64 + 32) * 2), 60000u);
    gst_buffer_unmap(depth.get(), &map);
}

/* The same picture in each plane, but for noise of about 2 DN; only the planes' numbers say that it was
 * swept. */
TEST_F(OddStacks, a_lens_that_never_moved_is_told_once)
{
    start("dffdepth unit=index");
    std::vector<guint8> bytes = gray_stack(width, height, planes, 0);
    const std::vector<guint8> plane(bytes.begin(), bytes.begin() + width * height);
    guint32 seed = 1;
    for (unsigned k = 0; k < 70; k++) {
        for (size_t i = 0; i < bytes.size(); i++) {
            seed = seed * 1664525 + 1013904223;
            bytes[i] = static_cast<guint8>(
                std::clamp(plane[i % plane.size()] + static_cast<int>(seed >> 29) - 4, 0, 255));
        }
        ASSERT_EQ(push(gst_buffer_new_memdup(bytes.data(), bytes.size())), GST_FLOW_OK);
        pull();
    }
    look();
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_.front().find("the lens moves"), std::string::npos) << warnings_.front();
}

/* Without noise either no pixel has any depth. */
TEST_F(OddStacks, planes_that_are_the_same_are_told_once)
{
    start("dffdepth unit=index");
    std::vector<guint8> bytes = gray_stack(width, height, planes, 0);
    for (unsigned z = 1; z < planes; z++)
        std::copy_n(bytes.begin(), width * height, bytes.begin() + z * width * height);
    for (unsigned k = 0; k < 40; k++) {
        ASSERT_EQ(push(gst_buffer_new_memdup(bytes.data(), bytes.size())), GST_FLOW_OK);
        pull();
    }
    look();
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_.front().find("the lens moves"), std::string::npos) << warnings_.front();
}

TEST_F(OddStacks, a_lens_that_moved_is_not_spoken_of)
{
    for (const char *element : {"dffdepth", "dffdepth method=paper"}) {
        start(element);
        for (unsigned k = 0; k < 40; k++) {
            ASSERT_EQ(push(new_stack(k, k)), GST_FLOW_OK);
            pull();
        }
        look();
        EXPECT_TRUE(warnings_.empty()) << element << ": " << warnings_.front();
        TearDown();
    }
    start("dffdepth");
}

TEST_F(OddStacks, untimed_ones_are_timed_anew_after_a_flush)
{
    start("dffdepth unit=index");
    for (unsigned pass = 0; pass < 2; pass++) {
        GstSegment segment;
        gst_segment_init(&segment, GST_FORMAT_BYTES);
        gst_harness_push_event(harness_.get(), gst_event_new_segment(&segment));
        for (unsigned k = 0; k < 3; k++) {
            ASSERT_EQ(push(bare_stack()), GST_FLOW_OK);
            EXPECT_EQ(GST_BUFFER_PTS(pull().get()), k * GST_SECOND / 10) << "pass " << pass;
        }
        gst_harness_push_event(harness_.get(), gst_event_new_flush_start());
        gst_harness_push_event(harness_.get(), gst_event_new_flush_stop(TRUE));
    }
}

namespace {

/* aifcompose between two applications' sources. */
class OddPictures : public testing::Test {
protected:
    static void SetUpTestSuite() { gst_init(nullptr, nullptr); }

    void start(const std::string &stacks = stack_caps())
    {
        pipeline_.emplace(
            "appsrc name=s format=time caps=\"" + stacks +
            "\" ! c.stack  appsrc name=d format=time "
            "caps=\"video/x-raw,format=GRAY16_LE,width=64,height=64,framerate=10/1\" ! c.depth  "
            "aifcompose name=c ! appsink name=out sync=false");
        pipeline_->play();
    }

    void push(const char *source, GstBuffer *buffer)
    {
        GstFlowReturn flow = GST_FLOW_OK;
        g_signal_emit_by_name(pipeline_->element(source), "push-buffer", buffer, &flow);
        gst_buffer_unref(buffer);
    }

    /* Pictures until the end of both streams. */
    size_t end()
    {
        for (const char *source : {"s", "d"}) {
            GstFlowReturn flow = GST_FLOW_OK;
            g_signal_emit_by_name(pipeline_->element(source), "end-of-stream", &flow);
        }
        const std::vector<GstSample *> samples = pipeline_->pull_all("out");
        for (GstSample *sample : samples)
            gst_sample_unref(sample);
        return samples.size();
    }

    guint64 without_depth()
    {
        g_autoptr(GstStructure) stats = nullptr;
        g_object_get(pipeline_->element("c"), "stats", &stats, nullptr);
        guint64 count = 0;
        gst_structure_get_uint64(stats, "without-depth", &count);
        return count;
    }

    std::optional<dff::TestPipeline> pipeline_;
};

} // namespace

TEST_F(OddPictures, one_with_an_impossible_meta_is_the_mean_of_its_planes)
{
    start();
    const std::vector<std::function<GstBuffer *(unsigned)>> stacks{
        [](unsigned k) { return new_stack(k, k); }, [](unsigned k) { return new_stack(k, k, 64); },
        [](unsigned k) { return new_stack(k, k, planes, HUGE_VAL); },
        [](unsigned k) { return new_stack(k, k); }};
    for (unsigned k = 0; k < stacks.size(); k++) {
        push("d", new_depth(k, k, 0xffff));
        push("s", stacks[k](k));
    }
    EXPECT_EQ(end(), 4u);
    EXPECT_EQ(without_depth(), 2u);
}

TEST_F(OddPictures, a_depth_map_of_a_lying_layout_ends_the_stream)
{
    for (const gint stride : {64, 4096, -128}) {
        start();
        GstBuffer *depth = new_depth(0, 0);
        gsize offset[GST_VIDEO_MAX_PLANES] = {};
        gint strides[GST_VIDEO_MAX_PLANES] = {stride};
        gst_buffer_add_video_meta_full(depth, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_GRAY16_LE, 64, 64,
                                       1, offset, strides);
        push("d", depth);
        push("s", new_stack(0, 0));
        EXPECT_NE(pipeline_->wait().error.find("GstVideoMeta"), std::string::npos) << stride;
    }
}

TEST_F(OddPictures, a_wrong_size_is_told_with_size_and_limit)
{
    start(stack_caps(32, 64));
    push("s", new_stack(0, 0));
    const std::string error = pipeline_->wait().error;
    EXPECT_NE(error.find("32x64"), std::string::npos) << error;
}

/* Where segments count in bytes, what asks for running times is not to be heard. */
TEST_F(OddPictures, files_draw_no_critical_messages)
{
    const GLogLevelFlags before = g_log_set_always_fatal(
        static_cast<GLogLevelFlags>(int{G_LOG_LEVEL_CRITICAL} | int{G_LOG_LEVEL_ERROR}));
    const std::string bytes = dff::write_file("bytes", std::vector<guint8>(size_t{64} * 64 * 4 * 6, 90));
    const auto file = [&](size_t blocksize, const std::string &caps) {
        return "filesrc location=" + bytes + " blocksize=" + std::to_string(blocksize) +
               " ! capsfilter caps=\"" + caps + ",width=64,height=64,framerate=30/1\" ! ";
    };
    for (const std::string &pipeline :
         {file(64 * 64, "video/x-raw,format=GRAY8") + "lenssweeptag planes=3 ! fakesink",
          file(64 * 64 * 4, "video/x-raw,format=RGBx") + "l.color  " +
              file(64 * 64 * 2, "video/x-raw,format=GRAY16_LE") +
              "l.depth lightfieldcompose name=l ! fakesink",
          file(64 * 64 * 3, "video/x-focal-stack,format=GRAY8,planes=3") + "c.stack  " +
              file(64 * 64 * 2, "video/x-raw,format=GRAY16_LE") + "c.depth aifcompose name=c ! fakesink"})
        EXPECT_TRUE(dff::run(pipeline).end_of_stream) << pipeline;
    g_log_set_always_fatal(before);
}

TEST_F(OddPictures, numbers_that_begin_anew_cost_no_depth)
{
    start();
    const std::vector<unsigned> numbers{0, 1, 2, 3, 4, 0, 1, 2, 3, 4};
    for (unsigned k = 0; k < numbers.size(); k++) {
        push("s", new_stack(k, numbers[k]));
        if (k != 4)
            push("d", new_depth(k, numbers[k]));
    }
    EXPECT_EQ(end(), 10u);
    EXPECT_EQ(without_depth(), 1u);
}
