/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include <cmath>
#include <gst/check/gstharness.h>
#include <gst/dff/dff.h>
#include <gst/rtp/rtp.h>
#include <gtest/gtest.h>
#include <memory>
#include <string>

namespace {

const char *const uri = "urn:gst-plugins-dff:rtp-hdrext:metas";
const char *const extmap = "application/x-rtp,extmap-1=(string)urn:gst-plugins-dff:rtp-hdrext:metas";
constexpr gsize frame_size = 64 * 48;

struct HarnessDeleter {
    void operator()(GstHarness *harness) const { gst_harness_teardown(harness); }
};
using Harness = std::unique_ptr<GstHarness, HarnessDeleter>;

/* A payloader and a depayloader, with the packets in between in the test's hands. */
class MetasOverRtp : public testing::Test {
protected:
    void SetUp() override
    {
        payloader.reset(gst_harness_new_parse("rtpgstpay mtu=1200"));
        gst_harness_set_sink_caps_str(payloader.get(), extmap);
        gst_harness_set_src_caps_str(payloader.get(),
                                     "video/x-raw,format=GRAY8,width=64,height=48,framerate=30/1");
        depayloader.reset(gst_harness_new("rtpgstdepay"));
    }

    /* The packets of one frame. */
    std::vector<GstBuffer *> packets_of(GstBuffer *frame)
    {
        GST_BUFFER_PTS(frame) = 0;
        EXPECT_EQ(gst_harness_push(payloader.get(), frame), GST_FLOW_OK);
        std::vector<GstBuffer *> packets;
        while (gst_harness_buffers_in_queue(payloader.get()) > 0)
            packets.push_back(gst_harness_pull(payloader.get()));
        return packets;
    }

    GstBuffer *frame_of(const std::vector<GstBuffer *> &packets)
    {
        g_autoptr(GstCaps) caps = gst_pad_get_current_caps(payloader->sinkpad);
        gst_harness_set_src_caps(depayloader.get(), gst_caps_ref(caps));
        for (GstBuffer *packet : packets)
            EXPECT_EQ(gst_harness_push(depayloader.get(), packet), GST_FLOW_OK);
        return gst_harness_pull(depayloader.get());
    }

    Harness payloader;
    Harness depayloader;
};

GstBuffer *blank_frame()
{
    GstBuffer *frame = gst_buffer_new_allocate(nullptr, frame_size, nullptr);
    gst_buffer_memset(frame, 0, 0x55, frame_size);
    return frame;
}

GstFocusInfo some_focus()
{
    return {1ULL << 40, 3, 6, 1.25, NAN, 512, 6000000, 65535};
}

GstDepthInfo some_depth()
{
    GstDepthInfo depth;
    gst_depth_info_init(&depth);
    depth.unit = GST_DEPTH_UNIT_DIOPTRE;
    depth.offset = 5.0;
    depth.scale = -1e-4;
    depth.near = 5.0;
    depth.far = 0.0;
    depth.has_intrinsics = TRUE;
    depth.fx = 601.5;
    depth.distortion[4] = -0.01;
    depth.sequence = 77;
    depth.sweep = 78;
    return depth;
}

TEST_F(MetasOverRtp, focus_and_depth_arrive_with_the_frame)
{
    GstBuffer *frame = blank_frame();
    const GstFocusInfo focus = some_focus();
    const GstDepthInfo depth = some_depth();
    gst_buffer_add_focus_meta(frame, &focus);
    gst_buffer_add_depth_meta(frame, &depth);

    g_autoptr(GstBuffer) received = frame_of(packets_of(frame));

    const GstFocusMeta *focus_meta = gst_buffer_get_focus_meta(received);
    ASSERT_NE(focus_meta, nullptr);
    EXPECT_EQ(focus_meta->sweep, focus.sweep);
    EXPECT_EQ(focus_meta->plane, focus.plane);
    EXPECT_EQ(focus_meta->power, focus.power);
    EXPECT_TRUE(std::isnan(focus_meta->position_um));
    EXPECT_EQ(focus_meta->frame_id, focus.frame_id);
    const GstDepthMeta *depth_meta = gst_buffer_get_depth_meta(received);
    ASSERT_NE(depth_meta, nullptr);
    EXPECT_EQ(depth_meta->unit, depth.unit);
    EXPECT_EQ(depth_meta->scale, depth.scale);
    EXPECT_EQ(depth_meta->sequence, depth.sequence);
    EXPECT_EQ(depth_meta->distortion[4], depth.distortion[4]);
}

TEST_F(MetasOverRtp, only_the_last_packet_of_a_frame_carries_them)
{
    GstBuffer *frame = blank_frame();
    const GstFocusInfo focus = some_focus();
    gst_buffer_add_focus_meta(frame, &focus);

    const auto packets = packets_of(frame);

    ASSERT_GT(packets.size(), 2U);
    for (GstBuffer *packet : packets) {
        GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
        ASSERT_TRUE(gst_rtp_buffer_map(packet, GST_MAP_READ, &rtp));
        EXPECT_EQ(gst_rtp_buffer_get_extension(&rtp), gst_rtp_buffer_get_marker(&rtp));
        gst_rtp_buffer_unmap(&rtp);
        gst_buffer_unref(packet);
    }
}

TEST_F(MetasOverRtp, a_frame_without_metas_arrives_without)
{
    g_autoptr(GstBuffer) received = frame_of(packets_of(blank_frame()));

    EXPECT_EQ(gst_buffer_get_size(received), frame_size);
    EXPECT_EQ(gst_buffer_get_focus_meta(received), nullptr);
    EXPECT_EQ(gst_buffer_get_depth_meta(received), nullptr);
}

/* Each byte of the extension broken in turn: the frames come, and nothing else happens. */
TEST(RtpHeaderExtensionDff, damaged_metas_do_no_harm)
{
    g_autoptr(GstRTPHeaderExtension) extension = gst_rtp_header_extension_create_from_uri(uri);
    ASSERT_NE(extension, nullptr);
    gst_rtp_header_extension_set_id(extension, 1);
    GstBuffer *frame = blank_frame();
    const GstFocusInfo focus = some_focus();
    const GstDepthInfo depth = some_depth();
    gst_buffer_add_focus_meta(frame, &focus);
    gst_buffer_add_depth_meta(frame, &depth);
    guint8 last_packet_header[12] = {0x80, 0x80};
    GstBuffer *packet = gst_buffer_new_memdup(last_packet_header, sizeof last_packet_header);
    std::vector<guint8> good(gst_rtp_header_extension_get_max_size(extension, frame));
    ASSERT_EQ(gst_rtp_header_extension_write(extension, frame, GST_RTP_HEADER_EXTENSION_TWO_BYTE, packet,
                                             good.data(), good.size()),
              static_cast<gssize>(good.size()));
    gst_buffer_unref(packet);
    gst_buffer_unref(frame);

    for (size_t position = 0; position < good.size(); position++) {
        std::vector<guint8> bad = good;
        bad[position] ^= 0xff;
        g_autoptr(GstBuffer) received = blank_frame();
        EXPECT_TRUE(gst_rtp_header_extension_read(extension, GST_RTP_HEADER_EXTENSION_TWO_BYTE, bad.data(),
                                                  bad.size(), received));
        EXPECT_TRUE(gst_rtp_header_extension_read(extension, GST_RTP_HEADER_EXTENSION_TWO_BYTE, good.data(),
                                                  position, received));
    }
}

} // namespace
