/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "proofs.h"

#include <cmath>
#include <gst/dff/dff.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

using namespace dff;

namespace {

struct SampleUnref {
    void operator()(GstSample *sample) const { gst_sample_unref(sample); }
};
using Sample = std::unique_ptr<GstSample, SampleUnref>;

Sample pull(const WatchedStream &stream, const char *name)
{
    g_autoptr(GstElement) sink = gst_bin_get_by_name(GST_BIN(stream.pipeline()), name);
    return Sample(gst_app_sink_try_pull_sample(GST_APP_SINK(sink), 20 * GST_SECOND));
}

cv::Mat1w depth_of(const Sample &sample, cv::Size size)
{
    GstBuffer *buffer = gst_sample_get_buffer(sample.get());
    cv::Mat1w depth(size);
    gst_buffer_extract(buffer, 0, depth.data, depth.total() * depth.elemSize());
    return depth;
}

/* In decibels; the peak is the whole sweep. Pixels without a value do not count. */
double psnr(const cv::Mat1w &depth, const cv::Mat1w &truth)
{
    double sum = 0.0;
    uint64_t count = 0;
    for (int y = 0; y < depth.rows; y++) {
        for (int x = 0; x < depth.cols; x++) {
            if (depth(y, x) == 0 || truth(y, x) == 0)
                continue;
            const double error = depth(y, x) - truth(y, x);
            sum += error * error;
            count++;
        }
    }
    return 10.0 * std::log10(65534.0 * 65534.0 * static_cast<double>(count) / sum);
}

} // namespace

TEST(Depth, is_that_of_the_simulated_scene)
{
    const bool full = seconds_of_proof(0.0) > 0.0;
    BenchProcess bench({full ? "--size=640x480" : "--size=320x240"});
    const WatchedStream stream(
        bench.source() +
        " planes=6 rate=26 near=5 far=0 ! focalstackmux ! tee name=s  s. ! queue ! dffdepth ! tee name=d"
        " d. ! queue ! c.depth  s. ! queue ! c.stack  aifcompose name=c ! appsink name=aif sync=false"
        " d. ! queue ! appsink name=depth sync=false");
    gst_element_set_state(stream.pipeline(), GST_STATE_PLAYING);
    Sample depth;
    for (int i = 0; i < 3; i++) {
        depth = pull(stream, "depth");
        ASSERT_TRUE(depth) << stream.stats();
        ASSERT_TRUE(pull(stream, "aif"));
    }
    const GstDepthMeta *meta = gst_buffer_get_depth_meta(gst_sample_get_buffer(depth.get()));
    ASSERT_TRUE(meta);
    EXPECT_EQ(meta->unit, GST_DEPTH_UNIT_DIOPTRE);
    const cv::Mat1w truth = cv::imread(bench.truth(), cv::IMREAD_UNCHANGED);
    ASSERT_FALSE(truth.empty());
    const double decibels = psnr(depth_of(depth, truth.size()), truth);
    std::printf("depth over GigE Vision, %dx%d: PSNR %.1f dB\n", truth.cols, truth.rows, decibels);
    EXPECT_GT(decibels, 26.0);
}
