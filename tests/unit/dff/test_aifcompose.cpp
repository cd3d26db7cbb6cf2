/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_pipeline.h"

#include <algorithm>
#include <gtest/gtest.h>

using dff::Outcome;
using dff::run;
using dff::TestPipeline;

namespace {

/* Stacks to a tee, depth computed and passed through `on_depth`, and the picture in appsink "out". */
std::string graph(const std::string &source, const std::string &on_depth = "identity")
{
    return source + " ! tee name=s  s. ! queue ! dffdepth ! " + on_depth +
           " ! queue ! c.depth  s. ! queue ! c.stack  aifcompose name=c ! appsink name=out sync=false";
}

const std::string sweep = "lenssweeptestsrc num-buffers=60 ! video/x-raw,width=128,height=96 ! focalstackmux";

std::vector<guint8> bytes_of(GstSample *sample)
{
    GstMapInfo map;
    gst_buffer_map(gst_sample_get_buffer(sample), &map, GST_MAP_READ);
    std::vector<guint8> bytes(map.data, map.data + map.size);
    gst_buffer_unmap(gst_sample_get_buffer(sample), &map);
    return bytes;
}

void unref_all(const std::vector<GstSample *> &samples)
{
    for (GstSample *sample : samples)
        gst_sample_unref(sample);
}

} // namespace

TEST(AifCompose, every_stack_becomes_a_picture_of_its_time)
{
    TestPipeline pipeline(graph(sweep));
    pipeline.play();
    const std::vector<GstSample *> samples = pipeline.pull_all("out");
    ASSERT_EQ(samples.size(), 10u);
    for (size_t k = 0; k < samples.size(); k++) {
        const GstClockTime pts = GST_BUFFER_PTS(gst_sample_get_buffer(samples[k]));
        EXPECT_NEAR(static_cast<double>(pts), k * 1e9 / 26, 2.0);
    }
    unref_all(samples);
}

TEST(AifCompose, every_format_runs)
{
    for (const char *format :
         {"GRAY8", "GRAY16_LE", "I420", "NV12", "RGB", "BGR", "RGBx", "BGRx", "RGBA64_LE"}) {
        TestPipeline pipeline(
            graph("lenssweeptestsrc num-buffers=12 ! video/x-raw,width=101,height=75,format=" +
                  std::string(format) + " ! focalstackmux"));
        pipeline.play();
        const std::vector<GstSample *> samples = pipeline.pull_all("out");
        EXPECT_EQ(samples.size(), 2u) << format;
        unref_all(samples);
    }
}

TEST(AifCompose, a_picture_is_sharper_than_any_plane_of_its_stack)
{
    const std::string scene =
        "lenssweeptestsrc num-buffers=6 ! video/x-raw,width=320,height=240,format=GRAY8 ! ";
    TestPipeline planes(scene + "appsink name=out sync=false"), pictures(graph(scene + "focalstackmux"));
    planes.play();
    pictures.play();
    const auto sharpness = [](const std::vector<guint8> &picture) {
        double sum = 0.0;
        for (size_t i = 1; i < picture.size(); i++)
            sum += (picture[i] - picture[i - 1]) * (picture[i] - picture[i - 1]);
        return sum / static_cast<double>(picture.size());
    };
    double sharpest_plane = 0.0;
    const std::vector<GstSample *> samples = planes.pull_all("out");
    for (GstSample *sample : samples)
        sharpest_plane = std::max(sharpest_plane, sharpness(bytes_of(sample)));
    unref_all(samples);
    g_autoptr(GstSample) picture = pictures.pull("out");
    EXPECT_GT(sharpness(bytes_of(picture)), 1.2 * sharpest_plane);
}

TEST(AifCompose, a_lost_depth_map_does_not_shift_the_others)
{
    TestPipeline whole(graph(sweep));
    /* identity drops a few maps on its way, always the same ones. */
    TestPipeline holes(graph(sweep, "identity drop-probability=0.4"));
    whole.play();
    holes.play();
    const std::vector<GstSample *> expected = whole.pull_all("out"), found = holes.pull_all("out");
    ASSERT_EQ(expected.size(), 10u);
    ASSERT_EQ(found.size(), 10u) << "a stack without depth is a picture all the same";
    size_t same = 0;
    for (size_t k = 0; k < found.size(); k++) {
        EXPECT_EQ(GST_BUFFER_PTS(gst_sample_get_buffer(found[k])),
                  GST_BUFFER_PTS(gst_sample_get_buffer(expected[k])));
        same += bytes_of(found[k]) == bytes_of(expected[k]);
    }
    EXPECT_GT(same, 0u);
    EXPECT_LT(same, 10u);
    unref_all(expected);
    unref_all(found);
}

TEST(AifCompose, lost_stacks_do_not_shift_the_depth)
{
    TestPipeline whole(graph(sweep));
    TestPipeline holes(
        sweep + " ! tee name=s  s. ! queue ! dffdepth ! queue ! c.depth  s. ! queue "
                "! identity drop-probability=0.4 ! c.stack  aifcompose name=c ! appsink name=out sync=false");
    whole.play();
    holes.play();
    const std::vector<GstSample *> expected = whole.pull_all("out"), found = holes.pull_all("out");
    EXPECT_LT(found.size(), 10u);
    for (GstSample *sample : found) {
        const GstClockTime pts = GST_BUFFER_PTS(gst_sample_get_buffer(sample));
        const auto twin = std::find_if(expected.begin(), expected.end(), [&](GstSample *other) {
            return GST_BUFFER_PTS(gst_sample_get_buffer(other)) == pts;
        });
        ASSERT_NE(twin, expected.end());
        EXPECT_EQ(bytes_of(sample), bytes_of(*twin));
    }
    unref_all(expected);
    unref_all(found);
}

TEST(AifCompose, a_stack_without_usable_depth_becomes_the_mean_of_its_planes)
{
    const std::vector<guint8> blank = dff::gray_stack(64, 64, 4, 99);
    const std::string file = dff::write_file("blank", blank);
    TestPipeline pipeline(graph("multifilesrc location=" + file +
                                " num-buffers=1 caps=\"video/x-focal-stack,format=GRAY8,"
                                "width=64,height=64,planes=4,framerate=1/1\""));
    pipeline.play();
    g_autoptr(GstSample) picture = pipeline.pull("out");
    ASSERT_NE(picture, nullptr);
    for (const guint8 pixel : bytes_of(picture))
        ASSERT_EQ(pixel, 120);
}

TEST(AifCompose, one_stack_in_four_impossible_to_compute_does_not_hold_up_the_others)
{
    std::vector<guint8> stacks;
    for (unsigned k = 0; k < 16; k++) {
        const std::vector<guint8> stack = dff::gray_stack(64, 64, 4, k % 4 == 1 ? 99 : k % 4);
        stacks.insert(stacks.end(), stack.begin(), stack.end());
    }
    TestPipeline pipeline(
        "filesrc location=" + dff::write_file("one_in_four", stacks) +
        " blocksize=16384 ! video/x-focal-stack,format=GRAY8,width=64,height=64,planes=4,framerate=10/1 "
        "! tee name=s  s. ! queue ! dffdepth ! tee name=d  d. ! queue ! c.depth  s. ! queue ! c.stack  "
        "aifcompose name=c ! appsink name=out sync=false  d. ! queue ! appsink name=depth sync=false");
    pipeline.play();
    const std::vector<GstSample *> pictures = pipeline.pull_all("out"), depths = pipeline.pull_all("depth");
    EXPECT_EQ(pictures.size(), 16u);
    ASSERT_EQ(depths.size(), 16u);
    for (size_t k = 0; k < depths.size(); k++)
        EXPECT_EQ(GST_BUFFER_FLAG_IS_SET(gst_sample_get_buffer(depths[k]), GST_BUFFER_FLAG_GAP), k % 4 == 1)
            << k;
    unref_all(pictures);
    unref_all(depths);
}

TEST(AifCompose, soft_blend_has_less_noise)
{
    const std::string noisy = "lenssweeptestsrc num-buffers=12 scene=slant blur-step=0.1 noise=strong seed=3 "
                              "! video/x-raw,width=128,height=96,format=GRAY8 ! focalstackmux";
    const auto temporal_noise = [&](const char *blend) {
        TestPipeline pipeline(noisy +
                              " ! tee name=s  s. ! queue ! dffdepth ! queue ! c.depth  s. ! queue ! c.stack  "
                              "aifcompose name=c blend=" +
                              blend + " ! appsink name=out sync=false");
        pipeline.play();
        g_autoptr(GstSample) a = pipeline.pull("out");
        g_autoptr(GstSample) b = pipeline.pull("out");
        const std::vector<guint8> first = bytes_of(a), second = bytes_of(b);
        double sum = 0.0;
        for (size_t i = 0; i < first.size(); i++)
            sum += (first[i] - second[i]) * (first[i] - second[i]);
        return sum;
    };
    EXPECT_LT(temporal_noise("soft"), 0.9 * temporal_noise("linear"));
}

TEST(AifCompose, a_pad_that_is_not_linked_is_an_error_and_no_hang)
{
    const Outcome no_depth = run(sweep + " ! queue ! c.stack aifcompose name=c ! fakesink", 10);
    EXPECT_NE(no_depth.error.find("\"depth\""), std::string::npos) << no_depth.error;
    const Outcome no_stack = run(sweep + " ! dffdepth ! queue ! c.depth aifcompose name=c ! fakesink", 10);
    EXPECT_NE(no_stack.error.find("\"stack\""), std::string::npos) << no_stack.error;
}

/* Two stacks, which are all in the queues before anybody could be told by the flow of a third. */
TEST(AifCompose, a_picture_that_nobody_after_it_takes_is_an_error_and_no_hang)
{
    const Outcome outcome =
        run("lenssweeptestsrc num-buffers=12 ! video/x-raw,width=128,height=96,format=GRAY8 ! focalstackmux "
            "! tee name=s  s. ! queue ! dffdepth ! queue ! c.depth  s. ! queue ! c.stack  "
            "aifcompose name=c ! queue ! video/x-raw,format=RGB ! fakesink",
            20);
    EXPECT_NE(outcome.error.find("GRAY8"), std::string::npos) << outcome.error;
    EXPECT_NE(outcome.error.find("videoconvert"), std::string::npos) << outcome.error;
}

TEST(AifCompose, pictures_come_after_a_seek_that_the_source_refuses)
{
    TestPipeline pipeline(graph("lenssweeptestsrc ! video/x-raw,width=128,height=96 ! focalstackmux"));
    pipeline.play();
    for (int k = 0; k < 3; k++)
        gst_sample_unref(pipeline.pull("out"));
    gst_element_seek_simple(pipeline.bin(), GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, 0);
    for (int k = 0; k < 40; k++) { /* more than were on their way */
        GstSample *sample = pipeline.pull("out");
        ASSERT_NE(sample, nullptr) << "picture " << k;
        gst_sample_unref(sample);
    }
}

TEST(AifCompose, depth_of_another_size_is_an_error_that_names_both)
{
    const Outcome outcome =
        run(sweep + " ! tee name=s  s. ! queue ! dffdepth ! videoscale method=nearest-neighbour "
                    "! video/x-raw,width=64,height=48 ! queue ! c.depth  s. ! queue ! c.stack  "
                    "aifcompose name=c ! fakesink");
    EXPECT_NE(outcome.error.find("64x48"), std::string::npos) << outcome.error;
    EXPECT_NE(outcome.error.find("128x96"), std::string::npos) << outcome.error;
}

TEST(AifCompose, pictures_too_small_for_the_kernels_are_refused)
{
    const std::string pictures = "videotestsrc num-buffers=2 ! video/x-raw,width=33,height=64,format=";
    const Outcome outcome = run(pictures + "GRAY8 ! lenssweeptag planes=2 ! focalstackmux ! c.stack  " +
                                pictures + "GRAY16_LE ! c.depth  aifcompose name=c ! fakesink");
    EXPECT_FALSE(outcome.end_of_stream);
    EXPECT_FALSE(outcome.error.empty());
}

TEST(AifCompose, depth_of_which_the_caps_alone_say_the_unit_gives_the_same_picture)
{
    const auto picture = [](const std::string &way) {
        TestPipeline pipeline(
            "lenssweeptestsrc num-buffers=6 near=5 far=0.5 ! video/x-raw,width=128,height=96 "
            "! focalstackmux ! tee name=s  s. ! queue ! dffdepth unit=millimetre " +
            way +
            "! queue ! c.depth  s. ! queue ! c.stack  aifcompose name=c ! appsink "
            "name=out sync=false");
        pipeline.play();
        g_autoptr(GstSample) sample = pipeline.pull("out");
        return bytes_of(sample);
    };
    EXPECT_EQ(picture("! gdppay ! gdpdepay "), picture("")) << "GDP keeps caps, but no metas";
}
