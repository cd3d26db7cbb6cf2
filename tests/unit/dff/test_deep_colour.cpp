/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* Colours of 16 bits, from the frames to the picture. */
#include "test_pipeline.h"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <set>

using dff::TestPipeline;

namespace {

constexpr unsigned width = 4096, height = 322, planes = 3, channels = 4;
constexpr unsigned texture_height = 64; /* above the ramp, of most contrast in one plane after the other */

/* Far enough from the texture for the coarsest band of blend=sharp. */
constexpr unsigned first_row = texture_height + 160;

constexpr unsigned ramp_step = 15, ramp_start[channels] = {100, 105, 4000, 65535};

/* A step a column, in each colour from another start; opaque. */
guint16 ramp_at(unsigned x, unsigned channel)
{
    return static_cast<guint16>(channel == 3 ? 65535 : ramp_start[channel] + ramp_step * x);
}

std::vector<guint8> make_frames(unsigned count)
{
    std::vector<guint16> samples(size_t{width} * height * channels * count);
    guint32 random = 1;
    std::vector<guint16> texture(size_t{width} * texture_height);
    for (guint16 &value : texture) {
        random = random * 1664525 + 1013904223;
        value = static_cast<guint16>(random >> 16);
    }
    size_t i = 0;
    for (unsigned z = 0; z < count; z++)
        for (unsigned y = 0; y < height; y++)
            for (unsigned x = 0; x < width; x++)
                for (unsigned channel = 0; channel < channels; channel++, i++) {
                    const bool is_sharp = x * planes / width == z % planes;
                    if (y >= texture_height || channel == 3)
                        samples[i] = ramp_at(x, channel);
                    else
                        samples[i] = texture[y * width + x] / (is_sharp ? 1 : 4);
                }
    std::vector<guint8> bytes(samples.size() * sizeof(guint16));
    std::memcpy(bytes.data(), samples.data(), bytes.size());
    return bytes;
}

/* The frames of a file as stacks, aligned, and their pictures in appsink "out". */
std::string graph(const std::string &file, const std::string &mux, const std::string &depth,
                  const std::string &blend)
{
    return "filesrc location=" + file + " blocksize=" + std::to_string(width * height * channels * 2) +
           " ! rawvideoparse format=rgba64-le framerate=30/1 width=" + std::to_string(width) +
           " height=" + std::to_string(height) + " ! lenssweeptag planes=3 ! focalstackmux " + mux +
           " ! queue ! focalstackalign ! tee name=s  s. ! queue ! dffdepth " + depth +
           " ! queue ! c.depth  s. ! queue ! c.stack  aifcompose name=c blend=" + blend +
           " ! video/x-raw,format=RGBA64_LE ! appsink name=out sync=false";
}

/* The ramp's rows of a picture: as in the frames, within `tolerance`, and with a value a column. */
void expect_ramp(GstSample *sample, int tolerance)
{
    GstMapInfo map;
    ASSERT_TRUE(gst_buffer_map(gst_sample_get_buffer(sample), &map, GST_MAP_READ));
    std::set<guint16> values;
    int farthest = 0;
    for (unsigned y = first_row; y < height; y++)
        for (unsigned i = 0; i < width * channels; i++) {
            guint16 value = 0;
            std::memcpy(&value, map.data + (size_t{y} * width * channels + i) * sizeof value, sizeof value);
            farthest = std::max(farthest, std::abs(value - ramp_at(i / channels, i % channels)));
            if (y == first_row && i % channels == 0)
                values.insert(value);
        }
    gst_buffer_unmap(gst_sample_get_buffer(sample), &map);
    EXPECT_LE(farthest, tolerance);
    EXPECT_EQ(values.size(), width);
}

struct Case {
    const char *depth, *blend;
};

class DeepColour : public testing::TestWithParam<Case> {};

} // namespace

TEST_P(DeepColour, a_ramp_keeps_its_4096_steps)
{
    const std::string file = dff::write_file("ramp", make_frames(planes));
    TestPipeline pipeline(graph(file, "", GetParam().depth, GetParam().blend));
    pipeline.play();
    const std::vector<GstSample *> samples = pipeline.pull_all("out");
    ASSERT_EQ(samples.size(), 1U) << pipeline.wait().error;
    expect_ramp(samples[0], 1);
    gst_sample_unref(samples[0]);
    std::remove(file.c_str());
}

INSTANTIATE_TEST_SUITE_P(Methods, DeepColour,
                         testing::Values(Case{"method=volume", "linear"}, Case{"method=volume", "soft"},
                                         Case{"method=volume", "sharp"}, Case{"method=paper", "linear"},
                                         Case{"method=paper", "sharp"}));

TEST(DeepColourStream, so_it_does_in_a_rolling_window)
{
    const std::string file = dff::write_file("rolling", make_frames(2 * planes));
    TestPipeline pipeline(graph(file, "window=rolling", "", "sharp"));
    pipeline.play();
    const std::vector<GstSample *> samples = pipeline.pull_all("out");
    EXPECT_EQ(samples.size(), planes + 1) << pipeline.wait().error;
    for (GstSample *sample : samples) {
        expect_ramp(sample, 1);
        gst_sample_unref(sample);
    }
    std::remove(file.c_str());
}
