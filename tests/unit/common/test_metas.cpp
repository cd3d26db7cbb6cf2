/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include <gst/check/gstharness.h>
#include <gst/dff/dff.h>

#include <cmath>
#include <gtest/gtest.h>
#include <memory>
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
