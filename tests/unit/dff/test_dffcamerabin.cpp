/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_pipeline.h"

#include <gtest/gtest.h>

using namespace dff;

namespace {

const std::string planes =
    "lenssweeptestsrc planes=6 num-buffers=18 ! video/x-raw,format=I420,width=160,height=120";

std::string camera(const std::string &source, const std::string &properties = "")
{
    return "dffcamerabin name=camera source=\"" + source + "\" " + properties + " ";
}

const std::string depth_out = " camera.depth ! appsink name=depth sync=false ";
const std::string aif_out = " camera.aif ! appsink name=aif sync=false ";

/* The bytes and sequence numbers of an output. */
struct Output {
    std::vector<std::vector<guint8>> frames;
    std::vector<guint64> sequences; /* of depth */
};

Output collect(const TestPipeline &pipeline, const char *sink)
{
    Output output;
    for (GstSample *sample : pipeline.pull_all(sink)) {
        GstBuffer *buffer = gst_sample_get_buffer(sample);
        std::vector<guint8> bytes(gst_buffer_get_size(buffer));
        gst_buffer_extract(buffer, 0, bytes.data(), bytes.size());
        output.frames.push_back(std::move(bytes));
        if (const GstDepthMeta *meta = gst_buffer_get_depth_meta(buffer))
            output.sequences.push_back(meta->sequence);
        gst_sample_unref(sample);
    }
    return output;
}

GstDepthUnit unit_of_first(const TestPipeline &pipeline)
{
    GstSample *sample = pipeline.pull("depth");
    EXPECT_NE(sample, nullptr);
    if (!sample)
        return GST_DEPTH_UNIT_AUTO;
    const GstDepthUnit unit = gst_buffer_get_depth_meta(gst_sample_get_buffer(sample))->unit;
    gst_sample_unref(sample);
    return unit;
}

guint64 stat(const TestPipeline &pipeline, const char *child, const char *name)
{
    GstStructure *stats = nullptr;
    guint64 value = 0;
    gst_child_proxy_get(GST_CHILD_PROXY(pipeline.element("camera")), (std::string(child) + "::stats").c_str(),
                        &stats, nullptr);
    EXPECT_TRUE(gst_structure_get_uint64(stats, name, &value));
    gst_structure_free(stats);
    return value;
}

} // namespace

TEST(DffCameraBin, gives_what_the_whole_graph_gives)
{
    TestPipeline bin(camera(planes) + depth_out + aif_out);
    bin.play();
    TestPipeline graph(planes + " ! focalstackmux ! tee name=s  s. ! queue ! dffdepth ! tee name=d "
                                "d. ! queue ! c.depth  s. ! queue ! c.stack "
                                "aifcompose name=c ! queue ! appsink name=aif sync=false "
                                "d. ! queue ! appsink name=depth sync=false");
    graph.play();
    const Output depth = collect(bin, "depth");
    EXPECT_EQ(depth.sequences, (std::vector<guint64>{0, 1, 2}));
    EXPECT_EQ(depth.frames, collect(graph, "depth").frames);
    const Output aif = collect(bin, "aif");
    EXPECT_EQ(aif.frames.size(), 3u);
    EXPECT_EQ(aif.frames, collect(graph, "aif").frames);
}

TEST(DffCameraBin, depth_alone_computes_no_pictures)
{
    TestPipeline pipeline(camera(planes) + depth_out);
    pipeline.play();
    EXPECT_EQ(collect(pipeline, "depth").frames.size(), 3u);
    EXPECT_TRUE(pipeline.wait().end_of_stream);
    EXPECT_EQ(stat(pipeline, "aifcompose", "pictures"), 0u);
}

TEST(DffCameraBin, pictures_come_without_a_link_for_the_depth)
{
    TestPipeline pipeline(camera(planes) + aif_out);
    pipeline.play();
    EXPECT_EQ(collect(pipeline, "aif").frames.size(), 3u);
    EXPECT_TRUE(pipeline.wait().end_of_stream);
}

TEST(DffCameraBin, nothing_linked_computes_nothing_and_stops_at_once)
{
    TestPipeline pipeline(camera(planes) + " videotestsrc num-buffers=1 ! fakesink");
    pipeline.play();
    g_usleep(300000);
    EXPECT_EQ(stat(pipeline, "dffdepth", "stacks"), 0u);
    pipeline.stop();
}

TEST(DffCameraBin, properties_of_its_parts_are_its_own)
{
    TestPipeline pipeline(camera(planes, "unit=millimetre lambda=2 blend=linear mux::on-missing=repeat") +
                          depth_out);
    pipeline.play();
    EXPECT_EQ(unit_of_first(pipeline), GST_DEPTH_UNIT_MILLIMETRE);
    gint blend = -1, missing = -1;
    gst_child_proxy_get(GST_CHILD_PROXY(pipeline.element("camera")), "aifcompose::blend", &blend,
                        "mux::on-missing", &missing, nullptr);
    EXPECT_EQ(blend, 0);
    EXPECT_NE(missing, 0);
}

TEST(DffCameraBin, unit_changes_while_it_runs)
{
    TestPipeline pipeline(camera("lenssweeptestsrc planes=6 ! video/x-raw,format=I420,width=160,height=120") +
                          " camera.depth ! appsink name=depth sync=false max-buffers=1");
    pipeline.play();
    EXPECT_EQ(unit_of_first(pipeline), GST_DEPTH_UNIT_DIOPTRE);
    g_object_set(pipeline.element("camera"), "unit", GST_DEPTH_UNIT_INDEX, nullptr);
    GstDepthUnit unit = GST_DEPTH_UNIT_DIOPTRE;
    for (int frame = 0; frame < 20 && unit != GST_DEPTH_UNIT_INDEX; frame++)
        unit = unit_of_first(pipeline);
    EXPECT_EQ(unit, GST_DEPTH_UNIT_INDEX);
}

TEST(DffCameraBin, a_source_of_stacks_needs_no_mux)
{
    TestPipeline pipeline(camera(planes + " ! focalstackmux ! focalstackalign") + depth_out);
    pipeline.play();
    EXPECT_EQ(collect(pipeline, "depth").frames.size(), 3u);
}

TEST(DffCameraBin, the_source_is_changed_between_two_runs)
{
    TestPipeline pipeline(camera(planes) + depth_out);
    pipeline.play();
    EXPECT_EQ(collect(pipeline, "depth").frames.size(), 3u);
    pipeline.stop();
    g_object_set(
        pipeline.element("camera"), "source",
        "videotestsrc num-buffers=8 ! video/x-raw,format=I420,width=96,height=96 ! lenssweeptag planes=4",
        nullptr);
    pipeline.play();
    const Output depth = collect(pipeline, "depth");
    ASSERT_EQ(depth.frames.size(), 2u);
    EXPECT_EQ(depth.frames[0].size(), 96u * 96u * 2u);
}

TEST(DffCameraBin, pictures_can_be_linked_and_unlinked_while_it_runs)
{
    TestPipeline pipeline(camera("lenssweeptestsrc planes=6 is-live=true rate=10 ! "
                                 "video/x-raw,format=I420,width=160,height=120") +
                          " camera.depth ! appsink name=depth sync=false max-buffers=1 drop=true "
                          "appsink name=aif sync=false max-buffers=1 drop=true async=false");
    pipeline.play();
    GstElement *bin = pipeline.element("camera"), *aif = pipeline.element("aif");
    for (int round = 0; round < 3; round++) {
        unit_of_first(pipeline);
        ASSERT_TRUE(gst_element_link_pads(bin, "aif", aif, "sink"));
        GstSample *picture = pipeline.pull("aif");
        ASSERT_NE(picture, nullptr) << "round " << round;
        gst_sample_unref(picture);
        gst_element_unlink_pads(bin, "aif", aif, "sink");
        unit_of_first(pipeline); /* goes on */
    }
    pipeline.stop();
}

TEST(DffCameraBin, the_light_field_alone_brings_its_pictures)
{
    gst_init(nullptr, nullptr);
    g_autoptr(GstElementFactory) factory = gst_element_factory_find("lightfieldcompose");
    if (!factory)
        GTEST_SKIP() << "lightfieldcompose is not built";
    TestPipeline pipeline(camera(planes) + " camera.lightfield ! appsink name=light sync=false");
    pipeline.play();
    EXPECT_EQ(collect(pipeline, "light").frames.size(), 3u);
    EXPECT_TRUE(pipeline.wait().end_of_stream);
    GstElement *bin = pipeline.element("camera");
    const guint16 children = GST_BIN_NUMCHILDREN(bin);
    pipeline.stop();
    g_autoptr(GstPad) pad = gst_element_get_static_pad(bin, "lightfield");
    gst_element_release_request_pad(bin, pad);
    EXPECT_EQ(GST_BIN_NUMCHILDREN(bin), children - 6);
}

TEST(DffCameraBin, goes_away_with_every_pad_in_use)
{
    gst_init(nullptr, nullptr);
    g_autoptr(GstElementFactory) factory = gst_element_factory_find("lightfieldcompose");
    const GLogLevelFlags fatal =
        g_log_set_always_fatal(static_cast<GLogLevelFlags>(G_LOG_FATAL_MASK | G_LOG_LEVEL_CRITICAL));
    {
        const TestPipeline pipeline(camera(planes) + " camera.depth ! fakesink camera.aif ! fakesink" +
                                    " camera.planes ! fakesink camera.stacks ! fakesink" +
                                    (factory ? " camera.lightfield ! fakesink" : ""));
    }
    g_log_set_always_fatal(fatal);
}

/* Depth of a recording, made while the same depth was computed. */
class Recordings : public testing::TestWithParam<std::string> {};

TEST_P(Recordings, give_the_same_depth_again)
{
    const std::string path = write_file(GetParam(), {});
    Output live;
    {
        TestPipeline pipeline(camera(planes) + depth_out + "camera." + GetParam() +
                              " ! dffmetapay ! gdppay ! filesink location=" + path);
        pipeline.play();
        live = collect(pipeline, "depth");
        EXPECT_TRUE(pipeline.wait().end_of_stream);
    }
    TestPipeline again(camera("filesrc location=" + path + " ! gdpdepay ! dffmetadepay") + depth_out);
    again.play();
    const Output replayed = collect(again, "depth");
    EXPECT_EQ(replayed.frames.size(), 3u);
    EXPECT_EQ(replayed.frames, live.frames);
    EXPECT_EQ(replayed.sequences, live.sequences);
    std::remove(path.c_str());
}

INSTANTIATE_TEST_SUITE_P(Of, Recordings, testing::Values("planes", "stacks"),
                         [](const auto &instance) { return instance.param; });

TEST(DffCameraBin, a_demuxer_finds_its_link)
{
    const std::string path = write_file("demuxer", {});
    const Outcome outcome = run("videotestsrc num-buffers=8 pattern=ball ! video/x-raw,format=I420,width=96,"
                                "height=96,framerate=10/1 ! matroskamux ! filesink location=" +
                                path);
    EXPECT_TRUE(outcome.end_of_stream) << outcome.error;
    TestPipeline pipeline(camera("filesrc location=" + path + " ! matroskademux ! lenssweeptag planes=4") +
                          depth_out);
    pipeline.play();
    EXPECT_EQ(collect(pipeline, "depth").frames.size(), 2u);
    std::remove(path.c_str());
}

TEST(DffCameraBin, frames_and_stacks_follow_each_other_in_one_bin)
{
    const std::string path = write_file("in-turn", {});
    EXPECT_TRUE(
        run(planes + " ! focalstackmux ! dffmetapay ! gdppay ! filesink location=" + path).end_of_stream);
    TestPipeline pipeline(camera(planes) + depth_out);
    for (const std::string &source : {"filesrc location=" + path + " ! gdpdepay ! dffmetadepay", planes,
                                      planes + " ! focalstackmux", planes}) {
        g_object_set(pipeline.element("camera"), "source", source.c_str(), nullptr);
        for (int round = 0; round < 2; round++) {
            pipeline.play();
            EXPECT_EQ(collect(pipeline, "depth").frames.size(), 3u) << source << ", round " << round;
            pipeline.stop();
        }
    }
    std::remove(path.c_str());
}

TEST(DffCameraBin, stats_are_those_of_all_its_parts)
{
    TestPipeline pipeline(camera(planes + " ! focalstackmux name=own ! focalstackdemux") + depth_out);
    pipeline.play();
    EXPECT_EQ(collect(pipeline, "depth").frames.size(), 3u);
    GstStructure *stats = nullptr;
    g_object_get(pipeline.element("camera"), "stats", &stats, nullptr);
    ASSERT_NE(stats, nullptr);
    for (const auto &[name, field, count] :
         {std::tuple("mux", "stacks", 3u), std::tuple("own", "frames", 18u),
          std::tuple("dffdepth", "stacks", 3u), std::tuple("aifcompose", "pictures", 0u)}) {
        g_autoptr(GstStructure) part = nullptr;
        guint64 value = 0;
        ASSERT_TRUE(gst_structure_get(stats, name, GST_TYPE_STRUCTURE, &part, nullptr)) << name;
        EXPECT_TRUE(gst_structure_get_uint64(part, field, &value)) << name;
        EXPECT_EQ(value, count) << name;
    }
    gst_structure_free(stats);
}

TEST(DffCameraBin, stacks_are_denoised_where_that_is_wanted)
{
    for (const auto &[settings, denoised] :
         {std::tuple("", 0u), std::tuple(" denoise-frames=4", 3u), std::tuple(" local-motion=true", 3u)}) {
        TestPipeline pipeline(camera(planes, settings) + depth_out);
        pipeline.play();
        EXPECT_EQ(collect(pipeline, "depth").frames.size(), 3u);
        EXPECT_EQ(stat(pipeline, "denoise", "stacks"), denoised) << settings;
    }
}

TEST(DffCameraBin, planes_and_stacks_can_be_taken_and_let_go_while_it_runs)
{
    TestPipeline pipeline(camera("lenssweeptestsrc planes=6 is-live=true rate=10 ! "
                                 "video/x-raw,format=I420,width=160,height=120") +
                          " camera.depth ! appsink name=depth sync=false max-buffers=1 drop=true "
                          "appsink name=tap sync=false max-buffers=1 drop=true async=false");
    pipeline.play();
    GstElement *bin = pipeline.element("camera"), *tap = pipeline.element("tap");
    const guint16 children = GST_BIN_NUMCHILDREN(bin);
    for (const char *name : {"planes", "stacks", "planes", "stacks"}) {
        unit_of_first(pipeline);
        g_autoptr(GstPad) pad = gst_element_request_pad_simple(bin, name);
        ASSERT_NE(pad, nullptr) << name;
        g_autoptr(GstPad) sink = gst_element_get_static_pad(tap, "sink");
        ASSERT_EQ(gst_pad_link(pad, sink), GST_PAD_LINK_OK) << name;
        GstSample *sample = pipeline.pull("tap");
        EXPECT_NE(sample, nullptr) << name;
        if (sample)
            gst_sample_unref(sample);
        gst_pad_unlink(pad, sink);
        gst_element_release_request_pad(bin, pad);
        unit_of_first(pipeline); /* goes on */
        EXPECT_EQ(GST_BIN_NUMCHILDREN(bin), children) << name;
    }
    pipeline.stop();
}

TEST(DffCameraBin, planes_of_a_source_of_stacks_are_refused)
{
    TestPipeline pipeline(camera(planes) + "camera.depth ! fakesink camera.planes ! fakesink");
    g_object_set(pipeline.element("camera"), "source", (planes + " ! focalstackmux").c_str(), nullptr);
    pipeline.play();
    const Outcome outcome = pipeline.wait();
    EXPECT_NE(outcome.error.find("planes"), std::string::npos) << outcome.error;
}

TEST(DffCameraBin, pictures_too_small_are_refused_with_the_limits)
{
    const Outcome outcome =
        run(camera("videotestsrc num-buffers=8 ! video/x-raw,format=I420,width=32,height=32 ! "
                   "lenssweeptag planes=4") +
                "camera.depth ! fakesink",
            20);
    for (const char *words : {"32x32", "64x64", "16384x16384"})
        EXPECT_NE(outcome.error.find(words), std::string::npos) << outcome.error;
}

TEST(DffCameraBin, a_source_that_cannot_be_used_is_named)
{
    for (const char *source : {"nosuchelement", "fakesink", "audiotestsrc"}) {
        const Outcome outcome = run(camera(source) + "camera.depth ! fakesink", 10);
        EXPECT_NE(outcome.error.find(source), std::string::npos) << outcome.error;
    }
}
