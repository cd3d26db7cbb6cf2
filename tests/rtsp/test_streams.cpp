/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* What arrives at clients. */
#include "receiver.h"
#include "server_process.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gst/dff/dff.h>
#include <gtest/gtest.h>
#include <memory>
#include <optional>
#include <vector>

namespace {

/* Small, so that the slowest machine keeps up. */
const std::string sweeps = "lenssweeptestsrc name=camera seed=7 planes=4 rate=5 noise=moderate motion=3 ";
const std::string small = "! video/x-raw,format=I420,width=96,height=64 ";
const std::string depth_of_stacks = "! focalstackmux ! dffdepth ";

std::string live_depth(const std::string &name)
{
    return sweeps + "is-live=true " + small + depth_of_stacks + "name=" + name;
}

std::string receive_depth(const ServerProcess &server, const std::string &protocol)
{
    return "rtspsrc latency=300 protocols=" + protocol + " location=" + server.url("/depth") +
           " ! rtpj2kdepay ! jpeg2000parse ! avdec_jpeg2000 ! appsink name=sink sync=false";
}

std::string checksum(GstBuffer *buffer)
{
    GstMapInfo map;
    gst_buffer_map(buffer, &map, GST_MAP_READ);
    g_autofree char *sum = g_compute_checksum_for_data(G_CHECKSUM_SHA256, map.data, map.size);
    gst_buffer_unmap(buffer, &map);
    return sum;
}

/* Depth of the first sweeps, computed here. */
std::vector<std::string> true_checksums(unsigned count)
{
    Receiver local(sweeps + small + depth_of_stacks + "! appsink name=sink sync=false");
    std::vector<std::string> checksums;
    for (unsigned k = 0; k < count; k++)
        checksums.push_back(checksum(local.next_buffer()));
    return checksums;
}

class DepthArrives : public testing::TestWithParam<std::string> {};

TEST_P(DepthArrives, bit_for_bit_with_its_meta)
{
    constexpr unsigned frames = 8;
    ServerProcess server(live_depth("depth"));
    Receiver client(receive_depth(server, GetParam()));

    guint64 last = 0;
    std::vector<std::pair<guint64, std::string>> received;
    for (unsigned k = 0; k < frames; k++) {
        GstBuffer *buffer = client.next_buffer();
        ASSERT_NE(buffer, nullptr) << "frame " << k;
        const GstDepthMeta *depth = gst_buffer_get_depth_meta(buffer);
        ASSERT_NE(depth, nullptr) << "frame " << k;
        EXPECT_EQ(depth->unit, GST_DEPTH_UNIT_DIOPTRE);
        EXPECT_EQ(depth->near, 5.0);
        last = depth->sequence;
        received.emplace_back(depth->sequence, checksum(buffer));
    }

    const auto expected = true_checksums(static_cast<unsigned>(last) + 1);
    for (const auto &[sequence, sum] : received)
        EXPECT_EQ(sum, expected.at(sequence)) << "stack " << sequence;
}

INSTANTIATE_TEST_SUITE_P(Protocols, DepthArrives, testing::Values("tcp", "udp"),
                         [](const auto &instance) { return instance.param; });

TEST(Streams, sdp_says_what_the_depth_means)
{
    ServerProcess server(live_depth("depth"));
    Receiver client("rtspsrc protocols=tcp location=" + server.url("/depth") +
                    " ! appsink name=sink sync=false");

    GstSample *sample = client.next();
    ASSERT_NE(sample, nullptr);
    const GstStructure *caps = gst_caps_get_structure(gst_sample_get_caps(sample), 0);
    EXPECT_STREQ(gst_structure_get_string(caps, "a-depth-unit"), "dioptre");
    EXPECT_STREQ(gst_structure_get_string(caps, "a-depth-near"), "5");
    EXPECT_STREQ(gst_structure_get_string(caps, "a-depth-far"), "0");
    const char *scale = gst_structure_get_string(caps, "a-depth-scale");
    ASSERT_NE(scale, nullptr);
    EXPECT_DOUBLE_EQ(g_ascii_strtod(scale, nullptr), -5.0 / 65534);
}

/* In the scale of the depth, as a difference. */
TEST(Streams, uncertainty_arrives_bit_for_bit_and_says_what_it_means)
{
    const std::string source = " name=d  d.src ! queue ! fakesink sync=false  d.uncertainty ! queue ! ";
    ServerProcess server(sweeps + "is-live=true " + small + depth_of_stacks + source +
                         "identity name=uncertainty");
    Receiver client("rtspsrc latency=300 protocols=tcp location=" + server.url("/uncertainty") +
                    " ! tee name=t  t. ! queue ! rtpj2kdepay ! jpeg2000parse ! avdec_jpeg2000 ! "
                    "appsink name=sink sync=false  t. ! queue ! appsink name=packets sync=false");
    GstBuffer *received = client.next_buffer();
    ASSERT_NE(received, nullptr);
    const guint64 sequence = gst_buffer_get_depth_meta(received)->sequence;

    Receiver local(sweeps + small + depth_of_stacks + source + "appsink name=sink sync=false");
    for (guint64 k = 0; k < sequence; k++)
        ASSERT_NE(local.next_buffer(), nullptr);
    EXPECT_EQ(checksum(received), checksum(local.next_buffer()));

    const GstStructure *caps = gst_caps_get_structure(gst_sample_get_caps(client.next("packets")), 0);
    EXPECT_STREQ(gst_structure_get_string(caps, "a-depth-offset"), "0");
    EXPECT_STREQ(gst_structure_get_string(caps, "a-depth-unit"), "dioptre");
}

/* The sender's clock at a frame, as RTCP tells it; nothing before the first sender report. */
std::optional<GstClockTime> sender_time(GstBuffer *buffer)
{
    g_autoptr(GstCaps) ntp = gst_caps_new_empty_simple("timestamp/x-ntp");
    const GstReferenceTimestampMeta *meta = gst_buffer_get_reference_timestamp_meta(buffer, ntp);
    return meta ? std::optional(meta->timestamp) : std::nullopt;
}

/* Colour made of the depth itself, so that the same frames are known on both sides. */
TEST(Streams, colour_and_depth_are_in_step)
{
    ServerProcess server(sweeps + "is-live=true " + small + depth_of_stacks +
                         "! tee name=depth  depth. ! queue ! identity name=aif");
    Receiver client(
        "rtspsrc name=source latency=300 add-reference-timestamp-meta=true location=" +
        server.url("/stream") +
        "  source. ! application/x-rtp,encoding-name=H264 ! rtph264depay ! appsink name=color sync=false"
        "  source. ! application/x-rtp,encoding-name=JPEG2000 ! rtpj2kdepay ! appsink name=depth sync=false");

    std::map<guint64, GstClockTime> times;
    unsigned compared = 0;
    for (unsigned k = 0; k < 100 && compared < 3; k++) {
        for (const char *sink : {"color", "depth"}) {
            GstBuffer *buffer = client.next_buffer(sink);
            ASSERT_NE(buffer, nullptr) << sink << " " << k;
            const GstDepthMeta *depth = gst_buffer_get_depth_meta(buffer);
            ASSERT_NE(depth, nullptr) << sink << " " << k;
            const auto time = sender_time(buffer);
            if (!time)
                continue;
            const auto [other, first] = times.emplace(depth->sequence, *time);
            if (first)
                continue;
            compared++;
            EXPECT_LT(std::abs(GST_CLOCK_DIFF(other->second, *time)), 100 * GST_USECOND)
                << "stack " << depth->sequence;
        }
    }
    EXPECT_GE(compared, 3U);
}

TEST(Streams, planes_give_the_same_depth_on_another_machine)
{
    ServerProcess server(sweeps + "is-live=true " + small + "! identity name=planes");
    Receiver client("rtspsrc latency=300 protocols=tcp location=" + server.url("/planes") +
                    " ! rtpgstdepay " + depth_of_stacks + "! appsink name=sink sync=false");

    std::vector<std::pair<guint64, std::string>> received;
    for (unsigned k = 0; k < 4; k++) {
        GstBuffer *buffer = client.next_buffer();
        ASSERT_NE(buffer, nullptr);
        received.emplace_back(gst_buffer_get_depth_meta(buffer)->sweep, checksum(buffer));
    }

    const auto expected = true_checksums(static_cast<unsigned>(received.back().first) + 1);
    for (const auto &[sweep, sum] : received)
        EXPECT_EQ(sum, expected.at(sweep)) << "sweep " << sweep;
}

/* The source ends after three sweeps each time; the client goes on and on. */
TEST(Streams, a_source_that_ends_is_started_again_for_the_same_client)
{
    ServerProcess server(sweeps + "is-live=true num-buffers=12 " + small + depth_of_stacks + "name=depth");
    Receiver client(receive_depth(server, "tcp"));

    for (unsigned k = 0; k < 7; k++)
        ASSERT_NE(client.next_buffer(), nullptr) << "frame " << k;
    EXPECT_GE(server.count_in_log("The source is started"), 2U);
}

TEST(Streams, one_capture_serves_all_and_stops_after_the_last)
{
    ServerProcess server(live_depth("depth"));
    auto first = std::make_unique<Receiver>(receive_depth(server, "tcp"));
    auto second = std::make_unique<Receiver>(receive_depth(server, "tcp"));
    ASSERT_NE(first->next_buffer(), nullptr);
    ASSERT_NE(second->next_buffer(), nullptr);
    EXPECT_EQ(server.count_in_log("The source is started"), 1U);

    first.reset();
    ASSERT_NE(second->next_buffer(), nullptr);
    EXPECT_EQ(server.count_in_log("the source is stopped"), 0U);
    second.reset();
    EXPECT_TRUE(server.wait_for_log("the source is stopped", 1));

    Receiver third(receive_depth(server, "tcp"));
    EXPECT_NE(third.next_buffer(), nullptr);
}

/* JPEG 2000 takes no picture of one pixel. */
TEST(Streams, a_mount_that_cannot_be_served_says_why_in_the_log)
{
    ServerProcess server("videotestsrc is-live=true ! video/x-raw,format=GRAY16_LE,width=1,height=1 ! "
                         "identity name=depth");
    EXPECT_NE(Receiver(receive_depth(server, "tcp")).error().find("503"), std::string::npos);
    EXPECT_TRUE(server.wait_for_log("/depth cannot be served: Failed to encode", 1));
}

/* Every kernel that runs leaves files in PoCL's cache. */
TEST(Streams, kernels_are_compiled_before_the_server_is_ready)
{
    g_autofree char *cache = g_dir_make_tmp("dff-kernels-XXXXXX", nullptr);
    const std::string before = g_getenv("POCL_CACHE_DIR") ? g_getenv("POCL_CACHE_DIR") : "";
    g_setenv("POCL_CACHE_DIR", cache, TRUE);
    ServerProcess server(sweeps + "is-live=true " + small +
                         "! focalstackmux ! dffdepth method=paper name=depth");
    before.empty() ? g_unsetenv("POCL_CACHE_DIR")
                   : static_cast<void>(g_setenv("POCL_CACHE_DIR", before.c_str(), TRUE));

    const auto files = [&] {
        const std::filesystem::recursive_directory_iterator all(cache);
        return std::count_if(begin(all), end(all),
                             [](const auto &entry) { return entry.path().extension() == ".so"; });
    };
    const auto compiled = files();
    EXPECT_GT(compiled, 0);
    EXPECT_NE(Receiver(receive_depth(server, "tcp")).next_buffer(), nullptr);
    EXPECT_EQ(files(), compiled);
    std::filesystem::remove_all(cache);
}

} // namespace
