/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include <gst/check/gstharness.h>
#include <gst/dff/dff.h>

#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

namespace {

struct BufferUnref {
    void operator()(GstBuffer *buffer) const { gst_buffer_unref(buffer); }
};
using Buffer = std::unique_ptr<GstBuffer, BufferUnref>;

GstFocusInfo some_focus(unsigned plane)
{
    return {.sweep = 0x123456789abcULL,
            .plane = plane,
            .planes = 6,
            .power = 2.5 - plane,
            .position_um = NAN,
            .code = -1,
            .exposure = 6 * GST_MSECOND,
            .frame_id = 65535 + plane};
}

GstDepthInfo some_depth()
{
    return {.unit = GST_DEPTH_UNIT_DIOPTRE,
            .scale = -1.0 / 65534,
            .offset = 5.0,
            .near = 5.0,
            .far = 0.0,
            .has_intrinsics = TRUE,
            .fx = 500.0,
            .fy = 510.0,
            .cx = 31.5,
            .cy = 23.5,
            .distortion = {0.1, -0.2, 0.3, -0.4, 0.5},
            .sequence = 42,
            .sweep = 43};
}

void expect_focus(const GstFocusInfo &found, const GstFocusInfo &wanted)
{
    EXPECT_EQ(found.sweep, wanted.sweep);
    EXPECT_EQ(found.plane, wanted.plane);
    EXPECT_EQ(found.planes, wanted.planes);
    EXPECT_DOUBLE_EQ(found.power, wanted.power);
    EXPECT_EQ(std::isnan(found.position_um), std::isnan(wanted.position_um));
    EXPECT_EQ(found.code, wanted.code);
    EXPECT_EQ(found.exposure, wanted.exposure);
    EXPECT_EQ(found.frame_id, wanted.frame_id);
}

void expect_focus_meta(GstBuffer *buffer, const GstFocusInfo &wanted)
{
    const GstFocusMeta *meta = gst_buffer_get_focus_meta(buffer);
    ASSERT_NE(meta, nullptr);
    GstFocusInfo found;
    gst_focus_meta_get_focus(meta, &found);
    expect_focus(found, wanted);
}

GstFocalStackMeta *add_some_stack_meta(GstBuffer *buffer)
{
    GstFocalStackMeta *meta = gst_buffer_add_focal_stack_meta(buffer, 99, 6);
    for (unsigned z = 0; z < 6; z++) {
        const GstFocusInfo focus = some_focus(z);
        gst_focal_stack_meta_set_focus(meta, z, &focus);
    }
    meta->complete = FALSE;
    meta->missing = 0b10;
    meta->repeated = 0b110;
    return meta;
}

void expect_some_stack_meta(GstBuffer *buffer)
{
    const GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(buffer);
    ASSERT_NE(meta, nullptr);
    EXPECT_EQ(meta->sequence, 99u);
    EXPECT_EQ(meta->planes, 6u);
    EXPECT_FALSE(meta->complete);
    EXPECT_EQ(meta->missing, 0b10u);
    EXPECT_EQ(meta->repeated, 0b110u);
    for (unsigned z = 0; z < 6; z++) {
        GstFocusInfo found;
        ASSERT_TRUE(gst_focal_stack_meta_get_focus(meta, z, &found));
        expect_focus(found, some_focus(z));
    }
}

void expect_same_depth(const GstDepthMeta *meta, const GstDepthInfo &wanted)
{
    ASSERT_NE(meta, nullptr);
    EXPECT_EQ(meta->unit, wanted.unit);
    EXPECT_DOUBLE_EQ(meta->scale, wanted.scale);
    EXPECT_DOUBLE_EQ(meta->offset, wanted.offset);
    EXPECT_DOUBLE_EQ(meta->near, wanted.near);
    EXPECT_DOUBLE_EQ(meta->far, wanted.far);
    EXPECT_EQ(meta->has_intrinsics, wanted.has_intrinsics);
    EXPECT_DOUBLE_EQ(meta->fx, wanted.fx);
    EXPECT_DOUBLE_EQ(meta->fy, wanted.fy);
    EXPECT_DOUBLE_EQ(meta->cx, wanted.cx);
    EXPECT_DOUBLE_EQ(meta->cy, wanted.cy);
    for (unsigned i = 0; i < 5; i++)
        EXPECT_DOUBLE_EQ(meta->distortion[i], wanted.distortion[i]);
    EXPECT_EQ(meta->sequence, wanted.sequence);
    EXPECT_EQ(meta->sweep, wanted.sweep);
}

/* What comes out of `element` when a buffer of `size` bytes goes in. */
Buffer through(const char *element, const char *in_caps, gsize size, void (*add_meta)(GstBuffer *))
{
    GstHarness *harness = gst_harness_new_parse(element);
    gst_harness_set_src_caps_str(harness, in_caps);
    GstBuffer *buffer = gst_buffer_new_allocate(nullptr, size, nullptr);
    gst_buffer_memset(buffer, 0, 7, size);
    GST_BUFFER_PTS(buffer) = 0;
    add_meta(buffer);
    EXPECT_EQ(gst_harness_push(harness, buffer), GST_FLOW_OK) << element;
    GstBuffer *out = gst_harness_try_pull(harness);
    gst_harness_teardown(harness);
    return Buffer(out);
}

void add_focus(GstBuffer *buffer)
{
    const GstFocusInfo focus = some_focus(3);
    gst_buffer_add_focus_meta(buffer, &focus);
}

void add_stack(GstBuffer *buffer)
{
    add_some_stack_meta(buffer);
}

void add_depth(GstBuffer *buffer)
{
    const GstDepthInfo depth = some_depth();
    gst_buffer_add_depth_meta(buffer, &depth);
}

/* Catches what GLib says of a caller's faults. */
class Messages {
public:
    Messages() : fatal_(g_log_set_always_fatal(G_LOG_LEVEL_ERROR))
    {
        g_log_set_default_handler([](const gchar *, GLogLevelFlags, const gchar *,
                                     gpointer data) { (*static_cast<unsigned *>(data))++; },
                                  count_.get());
    }
    ~Messages()
    {
        g_log_set_default_handler(g_log_default_handler, nullptr);
        g_log_set_always_fatal(fatal_);
    }
    Messages(const Messages &) = delete;
    Messages &operator=(const Messages &) = delete;

    unsigned count() const { return *count_; }

private:
    std::unique_ptr<unsigned> count_ = std::make_unique<unsigned>(0);
    GLogLevelFlags fatal_;
};

} // namespace

struct Conversion {
    const char *element;
    const char *caps;
    gsize size;
};

class SurvivesConversion : public testing::TestWithParam<Conversion> {};

TEST_P(SurvivesConversion, focus_and_stack_metas)
{
    const auto &[element, caps, size] = GetParam();
    const Buffer frame = through(element, caps, size, add_focus);
    ASSERT_TRUE(frame);
    expect_focus_meta(frame.get(), some_focus(3));
    const Buffer stack = through(element, caps, size, add_stack);
    ASSERT_TRUE(stack);
    expect_some_stack_meta(stack.get());
}

INSTANTIATE_TEST_SUITE_P(
    Metas, SurvivesConversion,
    testing::Values(Conversion{"videoconvert ! capsfilter caps=video/x-raw,format=I420",
                               "video/x-raw,format=RGB,width=64,height=48,framerate=30/1", 64 * 48 * 3},
                    Conversion{"videoscale ! capsfilter caps=video/x-raw,width=32,height=24",
                               "video/x-raw,format=GRAY8,width=64,height=48,framerate=30/1", 64 * 48},
                    Conversion{"bayer2rgb", "video/x-bayer,format=rggb,width=64,height=48,framerate=30/1",
                               64 * 48},
                    Conversion{"videocrop left=8 top=4",
                               "video/x-raw,format=GRAY8,width=64,height=48,framerate=30/1", 64 * 48}));

TEST(FocusMeta, goes_with_a_copy_once)
{
    const Buffer buffer(gst_buffer_new_allocate(nullptr, 16, nullptr));
    add_focus(buffer.get());
    const Buffer copy(gst_buffer_copy(buffer.get()));
    expect_focus_meta(copy.get(), some_focus(3));
    gst_buffer_copy_into(copy.get(), buffer.get(), GST_BUFFER_COPY_META, 0, static_cast<gsize>(-1));
    EXPECT_EQ(gst_buffer_get_n_meta(copy.get(), GST_FOCUS_META_API_TYPE), 1u);
}

TEST(StackMeta, goes_with_a_copy_once)
{
    const Buffer buffer(gst_buffer_new_allocate(nullptr, 16, nullptr));
    add_some_stack_meta(buffer.get());
    const Buffer copy(gst_buffer_copy(buffer.get()));
    expect_some_stack_meta(copy.get());
    gst_buffer_copy_into(copy.get(), buffer.get(), GST_BUFFER_COPY_META, 0, static_cast<gsize>(-1));
    EXPECT_EQ(gst_buffer_get_n_meta(copy.get(), GST_FOCAL_STACK_META_API_TYPE), 1u);
}

TEST(DepthMeta, goes_with_a_copy_once)
{
    const Buffer buffer(gst_buffer_new_allocate(nullptr, 16, nullptr));
    add_depth(buffer.get());
    const Buffer copy(gst_buffer_copy(buffer.get()));
    expect_same_depth(gst_buffer_get_depth_meta(copy.get()), some_depth());
    gst_buffer_copy_into(copy.get(), buffer.get(), GST_BUFFER_COPY_META, 0, static_cast<gsize>(-1));
    EXPECT_EQ(gst_buffer_get_n_meta(copy.get(), GST_DEPTH_META_API_TYPE), 1u);
}

/* As in C, where a message is all that a caller's fault comes to. */
TEST(Metas, a_buffer_that_others_have_too_gets_none)
{
    const Buffer mine(gst_buffer_new());
    add_focus(mine.get());
    add_stack(mine.get());
    add_depth(mine.get());
    g_autoptr(GBytes) focus = gst_focus_meta_to_bytes(gst_buffer_get_focus_meta(mine.get()));
    g_autoptr(GBytes) stack = gst_focal_stack_meta_to_bytes(gst_buffer_get_focal_stack_meta(mine.get()));
    g_autoptr(GBytes) depth = gst_depth_meta_to_bytes(gst_buffer_get_depth_meta(mine.get()));
    const GstFocusInfo focus_info = some_focus(3);
    const GstDepthInfo depth_info = some_depth();

    const Buffer one(gst_buffer_new());
    const Buffer other(gst_buffer_ref(one.get()));
    const Messages messages;
    EXPECT_EQ(gst_buffer_add_focus_meta(one.get(), &focus_info), nullptr);
    EXPECT_EQ(gst_buffer_add_focal_stack_meta(one.get(), 0, 6), nullptr);
    EXPECT_EQ(gst_buffer_add_depth_meta(one.get(), &depth_info), nullptr);
    EXPECT_EQ(gst_buffer_add_focus_meta_from_bytes(one.get(), focus, nullptr), nullptr);
    EXPECT_EQ(gst_buffer_add_focal_stack_meta_from_bytes(one.get(), stack, nullptr), nullptr);
    EXPECT_EQ(gst_buffer_add_depth_meta_from_bytes(one.get(), depth, nullptr), nullptr);
    EXPECT_EQ(messages.count(), 6u);
}

TEST(Metas, layouts_are_not_written_to_a_buffer_that_others_have_too)
{
    g_autoptr(GstCaps) caps =
        gst_caps_from_string("video/x-focal-stack,format=GRAY8,width=64,height=64,planes=2,framerate=1/1");
    GstFocalStackInfo info;
    ASSERT_TRUE(gst_focal_stack_info_from_caps(&info, caps));
    const Buffer one(gst_buffer_new());
    const Buffer other(gst_buffer_ref(one.get()));
    const Messages messages;
    gst_focal_stack_info_add_video_metas(&info, one.get());
    EXPECT_EQ(messages.count(), 1u);
    EXPECT_EQ(gst_buffer_get_meta(one.get(), GST_VIDEO_META_API_TYPE), nullptr);
}

TEST(DepthMeta, has_a_unit_there_is)
{
    const Buffer buffer(gst_buffer_new());
    g_autoptr(GstCaps) caps = gst_caps_new_empty_simple("video/x-raw");
    const Messages messages;
    for (const int unit : {-1, static_cast<int>(GST_DEPTH_UNIT_AUTO), 5, 77}) {
        GstDepthInfo depth = some_depth();
        depth.unit = static_cast<GstDepthUnit>(unit);
        EXPECT_EQ(gst_buffer_add_depth_meta(buffer.get(), &depth), nullptr);
        gst_depth_info_to_caps(&depth, caps);
    }
    EXPECT_EQ(messages.count(), 8u);
}

TEST(StackMeta, has_no_plane_beyond_its_planes)
{
    const Buffer buffer(gst_buffer_new());
    const GstFocalStackMeta *meta = add_some_stack_meta(buffer.get());
    GstFocusInfo focus;
    EXPECT_FALSE(gst_focal_stack_meta_get_focus(meta, 6, &focus));
}

TEST(DepthMeta, scaling_scales_the_intrinsics)
{
    const Buffer half =
        through("videoscale method=nearest-neighbour ! capsfilter caps=video/x-raw,width=32,height=12",
                "video/x-raw,format=GRAY16_LE,width=64,height=48,framerate=30/1", 64 * 48 * 2, add_depth);
    ASSERT_TRUE(half);
    GstDepthInfo wanted = some_depth();
    wanted.fx = 250.0;
    wanted.fy = 127.5;
    wanted.cx = 15.5;
    wanted.cy = 5.5;
    expect_same_depth(gst_buffer_get_depth_meta(half.get()), wanted);
}

/* 64x48 pixels, turned to 48x64. Before GStreamer 1.28 a flipped frame has no such meta at all. */
TEST(DepthMeta, a_flip_leaves_no_wrong_intrinsics)
{
    struct Flip {
        const char *direction;
        double fx, fy, cx, cy;
    };
    for (const Flip &flip :
         {Flip{"horiz", 500.0, 510.0, 63 - 31.5, 23.5}, Flip{"vert", 500.0, 510.0, 31.5, 47 - 23.5},
          Flip{"90r", 510.0, 500.0, 47 - 23.5, 31.5}, Flip{"90l", 510.0, 500.0, 23.5, 63 - 31.5}}) {
        const Buffer turned =
            through((std::string("videoflip video-direction=") + flip.direction).c_str(),
                    "video/x-raw,format=GRAY16_LE,width=64,height=48,framerate=30/1", 64 * 48 * 2, add_depth);
        ASSERT_TRUE(turned);
        const GstDepthMeta *meta = gst_buffer_get_depth_meta(turned.get());
        if (!meta || !meta->has_intrinsics)
            continue;
        EXPECT_DOUBLE_EQ(meta->fx, flip.fx) << flip.direction;
        EXPECT_DOUBLE_EQ(meta->fy, flip.fy) << flip.direction;
        EXPECT_DOUBLE_EQ(meta->cx, flip.cx) << flip.direction;
        EXPECT_DOUBLE_EQ(meta->cy, flip.cy) << flip.direction;
    }
}

#if GST_CHECK_VERSION(1, 24, 0)
TEST(Metas, go_to_other_processes)
{
    const Buffer sent(gst_buffer_new());
    const Buffer received(gst_buffer_new());
    add_focus(sent.get());
    add_stack(sent.get());
    add_depth(sent.get());
    gpointer state = nullptr;
    while (GstMeta *meta = gst_buffer_iterate_meta(sent.get(), &state)) {
        g_autoptr(GByteArray) bytes = g_byte_array_new();
        guint32 consumed = 0;
        ASSERT_TRUE(gst_meta_serialize_simple(meta, bytes));
        EXPECT_NE(gst_meta_deserialize(received.get(), bytes->data, bytes->len, &consumed), nullptr);
    }
    expect_focus_meta(received.get(), some_focus(3));
    expect_some_stack_meta(received.get());
    expect_same_depth(gst_buffer_get_depth_meta(received.get()), some_depth());
}
#endif

TEST(DepthMeta, unknown_intrinsics_stay_unknown)
{
    const Buffer half = through("videoscale ! capsfilter caps=video/x-raw,width=32,height=24",
                                "video/x-raw,format=GRAY16_LE,width=64,height=48,framerate=30/1", 64 * 48 * 2,
                                [](GstBuffer *buffer) {
                                    GstDepthInfo depth;
                                    gst_depth_info_init(&depth);
                                    gst_buffer_add_depth_meta(buffer, &depth);
                                });
    ASSERT_TRUE(half);
    const GstDepthMeta *meta = gst_buffer_get_depth_meta(half.get());
    ASSERT_NE(meta, nullptr);
    EXPECT_FALSE(meta->has_intrinsics);
    EXPECT_EQ(meta->cx, 0.0);
}

TEST(DepthCaps, unit_and_range_come_back)
{
    for (const GstDepthUnit unit : {GST_DEPTH_UNIT_INDEX, GST_DEPTH_UNIT_DIOPTRE, GST_DEPTH_UNIT_MILLIMETRE,
                                    GST_DEPTH_UNIT_MICROMETRE}) {
        GstDepthInfo depth = some_depth();
        depth.unit = unit;
        g_autoptr(GstCaps) caps = gst_caps_new_empty_simple("video/x-raw");
        gst_depth_info_to_caps(&depth, caps);
        GstDepthInfo found;
        gst_depth_info_init(&found);
        ASSERT_TRUE(gst_depth_info_from_caps(&found, caps));
        EXPECT_EQ(found.unit, unit);
        EXPECT_DOUBLE_EQ(found.near, 5.0);
        EXPECT_DOUBLE_EQ(found.far, 0.0);
    }
}

TEST(DepthCaps, caps_without_a_unit_or_with_a_wrong_one_are_no_depth)
{
    for (const char *text :
         {"video/x-raw", "video/x-raw,depth-unit=furlong", "video/x-raw,depth-unit=auto"}) {
        g_autoptr(GstCaps) caps = gst_caps_from_string(text);
        GstDepthInfo depth;
        gst_depth_info_init(&depth);
        EXPECT_FALSE(gst_depth_info_from_caps(&depth, caps)) << text;
    }
}

TEST(DepthCaps, an_unknown_range_is_not_written)
{
    GstDepthInfo depth;
    gst_depth_info_init(&depth);
    g_autoptr(GstCaps) caps = gst_caps_from_string("video/x-raw,depth-near=3.0,depth-far=1.0");
    gst_depth_info_to_caps(&depth, caps);
    EXPECT_FALSE(gst_structure_has_field(gst_caps_get_structure(caps, 0), "depth-near"));
    EXPECT_FALSE(gst_structure_has_field(gst_caps_get_structure(caps, 0), "depth-far"));
}
