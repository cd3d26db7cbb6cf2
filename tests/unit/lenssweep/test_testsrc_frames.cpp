/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "support.h"

#include "engine/scene/scene_slant.h"
#include "engine/scene/swept_camera.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace {

constexpr const char *small = "video/x-raw,width=64,height=48";

std::vector<Sample> frames_of(const std::string &properties, const std::string &caps = small,
                              const std::string &filter = "identity")
{
    Pipeline pipeline("lenssweeptestsrc " + properties + " ! " + caps + " ! " + filter +
                      " ! appsink name=out sync=false");
    pipeline.set_state(GST_STATE_PLAYING);
    return pipeline.pull_all("out");
}

double largest_difference(const std::vector<uint8_t> &a, const std::vector<uint8_t> &b)
{
    EXPECT_EQ(a.size(), b.size());
    int largest = 0;
    for (size_t i = 0; i < std::min(a.size(), b.size()); i++)
        largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

} // namespace

TEST(TestSrcFrames, say_which_plane_of_which_sweep_they_are)
{
    const auto samples = frames_of("planes=3 near=4 far=1 rate=10 num-buffers=7");
    ASSERT_EQ(samples.size(), 7U);
    for (guint i = 0; i < 7; i++) {
        const GstFocusMeta *focus = focus_of(samples[i]);
        ASSERT_NE(focus, nullptr);
        EXPECT_EQ(focus->sweep, i / 3);
        EXPECT_EQ(focus->plane, i % 3);
        EXPECT_EQ(focus->planes, 3U);
        EXPECT_DOUBLE_EQ(focus->power, 4.0 - 1.5 * (i % 3));
        EXPECT_TRUE(std::isnan(focus->position_um));
        EXPECT_EQ(focus->code, -1);
        EXPECT_EQ(focus->exposure, 6 * GST_MSECOND);
        EXPECT_EQ(focus->frame_id, i);
        const GstBuffer *buffer = gst_sample_get_buffer(samples[i].get());
        EXPECT_EQ(GST_BUFFER_PTS(buffer), i * GST_SECOND / 30);
        EXPECT_NEAR(static_cast<double>(GST_BUFFER_DURATION(buffer)), GST_SECOND / 30.0, 1.0);
        EXPECT_EQ(GST_BUFFER_OFFSET(buffer), i);
        EXPECT_EQ(GST_BUFFER_OFFSET_END(buffer), i + 1);
        EXPECT_EQ(GST_BUFFER_IS_DISCONT(buffer), i == 0);
    }
    const GstVideoInfo info = info_of(samples[0].get());
    EXPECT_EQ(info.fps_n, 30);
    EXPECT_EQ(info.fps_d, 1);
}

TEST(TestSrcFrames, exposure_fits_the_period)
{
    const auto samples = frames_of("planes=10 rate=100 num-buffers=1");
    EXPECT_LT(focus_of(samples[0])->exposure, GST_MSECOND);
    EXPECT_GT(focus_of(samples[0])->exposure, GST_MSECOND / 2);
}

TEST(TestSrcFrames, powers_replace_planes_near_and_far)
{
    const auto samples = frames_of("powers=\"<3.0,2.5,0.0>\" rate=2.5 num-buffers=4");
    ASSERT_EQ(samples.size(), 4U);
    EXPECT_DOUBLE_EQ(focus_of(samples[1])->power, 2.5);
    EXPECT_EQ(focus_of(samples[3])->sweep, 1U);
    EXPECT_EQ(info_of(samples[0].get()).fps_n, 15);
    EXPECT_EQ(info_of(samples[0].get()).fps_d, 2);
}

TEST(TestSrcFrames, are_i420_of_640_by_480_where_nobody_asks)
{
    Pipeline pipeline("lenssweeptestsrc num-buffers=1 ! appsink name=out sync=false");
    pipeline.set_state(GST_STATE_PLAYING);
    const Sample sample = pipeline.pull("out");
    const GstVideoInfo info = info_of(sample.get());
    EXPECT_EQ(GST_VIDEO_INFO_FORMAT(&info), GST_VIDEO_FORMAT_I420);
    EXPECT_EQ(GST_VIDEO_INFO_WIDTH(&info), 640);
    EXPECT_EQ(GST_VIDEO_INFO_HEIGHT(&info), 480);
}

TEST(TestSrcFrames, are_what_the_renderer_makes)
{
    const auto samples = frames_of("scene=slant planes=4 num-buffers=4 noise=mild seed=5 breathing=0.01",
                                   "video/x-raw,format=RGB,width=64,height=48");
    dff::SweptCameraSettings settings;
    settings.plan = dff::SweepPlan::even(4, 5.0, 0.0);
    settings.noise = *dff::SensorNoise::parse("mild");
    settings.breathing = 0.01;
    settings.seed = 5;
    const dff::SweptCamera camera(dff::make_slant({64, 48}, 5), settings);
    ASSERT_EQ(samples.size(), 4U);
    for (unsigned plane = 0; plane < 4; plane++) {
        const cv::Mat3b expected = camera.digitise(camera.expose(plane), plane, 0);
        const std::vector<uint8_t> bytes(expected.datastart, expected.dataend);
        EXPECT_EQ(largest_difference(bytes_of(samples[plane].get()), bytes), 0.0);
    }
}

class Formats : public testing::TestWithParam<const char *> {};

TEST_P(Formats, show_the_same_as_the_converted_rgb)
{
    const std::string format = GetParam();
    for (const std::string size : {"width=62,height=48", "width=63,height=37"}) {
        const std::string caps = "video/x-raw,format=" + format + "," + size;
        const auto direct = frames_of("num-buffers=2", caps);
        ASSERT_EQ(direct.size(), 2U);
        g_autofree gchar *exact = gst_caps_to_string(gst_sample_get_caps(direct[0].get()));
        const auto converted = frames_of("num-buffers=2", "video/x-raw,format=RGB," + size,
                                         "videoconvert ! " + std::string(exact));
        ASSERT_EQ(converted.size(), 2U);
        GstVideoInfo info = info_of(direct[0].get());
        EXPECT_EQ(bytes_of(direct[0].get()).size(), GST_VIDEO_INFO_SIZE(&info));
        for (size_t i = 0; i < 2; i++) {
            GstVideoFrame a;
            GstVideoFrame b;
            ASSERT_TRUE(gst_video_frame_map(&a, &info, gst_sample_get_buffer(direct[i].get()), GST_MAP_READ));
            ASSERT_TRUE(
                gst_video_frame_map(&b, &info, gst_sample_get_buffer(converted[i].get()), GST_MAP_READ));
            int largest = 0;
            for (guint c = 0; c < GST_VIDEO_INFO_N_COMPONENTS(&info); c++)
                for (int y = 0; y < GST_VIDEO_FRAME_COMP_HEIGHT(&a, c); y++)
                    for (int x = 0; x < GST_VIDEO_FRAME_COMP_WIDTH(&a, c); x++) {
                        const auto at = [&](const GstVideoFrame &f) {
                            return static_cast<const uint8_t *>(
                                GST_VIDEO_FRAME_COMP_DATA(&f, c))[y * GST_VIDEO_FRAME_COMP_STRIDE(&f, c) +
                                                                  x * GST_VIDEO_FRAME_COMP_PSTRIDE(&f, c)];
                        };
                        largest = std::max(largest, std::abs(at(a) - at(b)));
                    }
            EXPECT_EQ(largest, 0) << exact;
            gst_video_frame_unmap(&a);
            gst_video_frame_unmap(&b);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(TestSrc, Formats,
                         testing::Values("I420", "GRAY8", "GRAY16_LE", "NV12", "RGB", "BGR", "RGBx", "BGRx",
                                         "RGBA64_LE"),
                         [](const auto &format) { return std::string(format.param); });

TEST(TestSrcFrames, a_still_scene_is_replayed_without_a_copy)
{
    const auto samples = frames_of("planes=3 num-buffers=7");
    ASSERT_EQ(samples.size(), 7U);
    const auto memory = [&](size_t i) {
        return gst_buffer_peek_memory(gst_sample_get_buffer(samples[i].get()), 0);
    };
    EXPECT_EQ(memory(0), memory(3));
    EXPECT_EQ(memory(0), memory(6));
    EXPECT_NE(memory(0), memory(1));
    EXPECT_TRUE(GST_MEMORY_IS_READONLY(memory(0)));
}

TEST(TestSrcFrames, writing_into_one_does_not_change_the_next)
{
    const auto drawn = frames_of("num-buffers=12 planes=2", "video/x-raw,format=RGB,width=64,height=48",
                                 "videobalance brightness=0.5");
    const auto plain = frames_of("num-buffers=12 planes=2", "video/x-raw,format=RGB,width=64,height=48");
    EXPECT_EQ(bytes_of(drawn[0].get()), bytes_of(drawn[10].get()));
    EXPECT_NE(bytes_of(drawn[0].get()), bytes_of(plain[0].get()));
}

TEST(TestSrcFrames, noise_never_repeats)
{
    for (const std::string scene : {"", "motion=3 "}) {
        const auto samples = frames_of(scene + "planes=2 num-buffers=24 noise=moderate");
        ASSERT_EQ(samples.size(), 24U);
        for (guint i = 0; i < 24; i += 2)
            for (guint k = i + 2; k < 24; k += 2)
                EXPECT_NE(bytes_of(samples[i].get()), bytes_of(samples[k].get())) << i << " and " << k;
    }
}

TEST(TestSrcFrames, the_light_flickers_and_is_switched)
{
    const auto brightness_of = [](const std::string &properties) {
        std::vector<double> brightness;
        for (const Sample &sample : frames_of("scene=slant planes=2 rate=10 num-buffers=6 " + properties,
                                              "video/x-raw,format=GRAY8,width=64,height=64")) {
            const std::vector<uint8_t> bytes = bytes_of(sample.get());
            brightness.push_back(std::accumulate(bytes.begin(), bytes.end(), 0.0));
        }
        return brightness;
    };
    const auto steady = brightness_of("");
    const auto switched = brightness_of("light-switch=2");
    ASSERT_EQ(steady.size(), 6U);
    ASSERT_EQ(switched.size(), 6U);
    for (size_t i = 0; i < 6; i++)
        EXPECT_NEAR(switched[i] / steady[i], i / 2 == 1 ? 0.5 : 1.0, 0.02) << i;
    /* 6 ms of 10 ms that begin where the wave does: 1 + 0.3 (1 - cos 1.2 pi) / 1.2 pi. */
    EXPECT_NEAR(brightness_of("flicker=0.3")[0] / steady[0], 1.144, 0.02);
}

TEST(TestSrcFrames, many_planes_are_blurred_no_more_than_a_few)
{
    const auto blur_of_first = [](const std::string &properties) {
        const auto samples = frames_of("scene=slant num-buffers=1 " + properties,
                                       "video/x-raw,format=GRAY8,width=128,height=96");
        const std::vector<uint8_t> bytes = bytes_of(samples[0].get());
        const cv::Mat1b picture(96, 128, const_cast<uint8_t *>(bytes.data()));
        cv::Mat edges;
        cv::Laplacian(picture, edges, CV_32F);
        return cv::norm(edges);
    };
    EXPECT_EQ(blur_of_first("planes=6"), blur_of_first("planes=6 blur-step=2"));
    EXPECT_EQ(blur_of_first("planes=4"), blur_of_first("planes=4 blur-step=2"));
    EXPECT_NEAR(blur_of_first("planes=21") / blur_of_first("planes=21 blur-step=0.5"), 1.0, 1e-6);
}

TEST(TestSrcFrames, repeat_for_a_seed)
{
    const std::string properties = "planes=2 num-buffers=5 noise=strong motion=3 jitter=1 seed=";
    const auto first = frames_of(properties + "9");
    const auto again = frames_of(properties + "9");
    const auto other = frames_of(properties + "10");
    for (size_t i = 0; i < 5; i++) {
        EXPECT_EQ(bytes_of(first[i].get()), bytes_of(again[i].get()));
        EXPECT_NE(bytes_of(first[i].get()), bytes_of(other[i].get()));
    }
}

TEST(TestSrcFrames, a_moving_scene_changes_from_sweep_to_sweep)
{
    const auto samples = frames_of("planes=2 num-buffers=4 motion=3");
    EXPECT_NE(bytes_of(samples[0].get()), bytes_of(samples[2].get()));
}

TEST(TestSrcFrames, leave_faster_than_300_a_second_in_full_hd)
{
    Pipeline pipeline("lenssweeptestsrc num-buffers=1500 ! video/x-raw,format=I420,width=1920,height=1080 ! "
                      "appsink name=out sync=false max-buffers=4");
    pipeline.set_state(GST_STATE_PLAYING);
    const Sample first = pipeline.pull("out");
    const auto begin = std::chrono::steady_clock::now();
    int frames = 0;
    while (const Sample sample = pipeline.pull("out"))
        frames++;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    EXPECT_EQ(frames, 1499);
    EXPECT_GT(frames / seconds.count(), 300.0);
    printf("%.0f frames/s\n", frames / seconds.count());
}

TEST(TestSrcDepth, is_the_truth_in_dioptres_once_a_sweep)
{
    Pipeline pipeline("lenssweeptestsrc name=rig scene=slant planes=4 near=3 far=1 rate=5 num-buffers=9 ! "
                      "video/x-raw,width=32,height=101 ! queue ! fakesink "
                      "rig.depth ! queue ! appsink name=depth sync=false");
    pipeline.set_state(GST_STATE_PLAYING);
    const auto samples = pipeline.pull_all("depth");
    EXPECT_EQ(pipeline.wait(), "");
    ASSERT_EQ(samples.size(), 3U) << "the third sweep has begun";
    for (guint sweep = 0; sweep < 3; sweep++) {
        GstBuffer *buffer = gst_sample_get_buffer(samples[sweep].get());
        EXPECT_EQ(GST_BUFFER_PTS(buffer), sweep * GST_SECOND / 5);
        EXPECT_EQ(GST_BUFFER_DURATION(buffer), GST_SECOND / 5);
        const GstDepthMeta *meta = gst_buffer_get_depth_meta(buffer);
        ASSERT_NE(meta, nullptr);
        EXPECT_EQ(meta->unit, GST_DEPTH_UNIT_DIOPTRE);
        EXPECT_EQ(meta->near, 3.0);
        EXPECT_EQ(meta->far, 1.0);
        EXPECT_EQ(meta->sweep, sweep);
        EXPECT_EQ(meta->sequence, sweep);
        const auto depth = depth_of(samples[sweep].get());
        ASSERT_EQ(depth.size(), 32U * 101U);
        for (size_t y = 0; y <= 100; y++)
            EXPECT_NEAR(meta->offset + meta->scale * depth[y * 32 + 5],
                        1.0 + 2.0 * static_cast<double>(y) / 100.0, 1e-4);
    }
    const GstStructure *caps = gst_caps_get_structure(gst_sample_get_caps(samples[0].get()), 0);
    EXPECT_STREQ(gst_structure_get_string(caps, "depth-unit"), "dioptre");
    const GstVideoInfo info = info_of(samples[0].get());
    EXPECT_EQ(info.fps_n, 5);
}
