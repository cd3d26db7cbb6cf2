/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* Elements that bring depth out, started and stopped again and again and run for long. DFF_CYCLES (4) and
 * DFF_FRAMES (600) scale it; by hand, 200 and 10000. */
#include "live_objects.h"
#include "test_pipeline.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

using dff::TestPipeline;

namespace {

struct Chain {
    std::string name;
    std::string element;  /* without which there is nothing to test */
    std::string pipeline; /* %s: where num-buffers may stand; %c: name of a camera's calibration */
    unsigned frames_each; /* of the source, for one that comes out */
};

void PrintTo(const Chain &chain, std::ostream *stream)
{
    *stream << chain.name;
}

const std::string color_and_depth =
    "videotestsrc %s ! video/x-raw,format=RGB,width=48,height=32,framerate=26/1 ! queue ! e.color  "
    "videotestsrc %s ! video/x-raw,format=GRAY16_LE,width=48,height=32,framerate=26/1,depth-unit=dioptre,"
    "depth-near=(double)5,depth-far=(double)0.5 ! queue ! e.depth  ";
const std::string out = " ! appsink name=out sync=false max-buffers=4";

const Chain chains[] = {
    {"quilt", "lightfieldcompose", color_and_depth + "lightfieldcompose name=e columns=3 rows=2" + out, 1},
    {"elemental", "lightfieldcompose", color_and_depth + "lightfieldcompose name=e layout=elemental" + out,
     1},
    {"colours_and_back", "depthcolorize",
     "videotestsrc %s ! video/x-raw,format=GRAY16_LE,width=48,height=32 ! depthcolorize palette=hue ! "
     "depthuncolorize" +
         out,
     1},
    {"openexr", "depthexrenc", color_and_depth + "depthexrenc name=e" + out, 1},
    {"ply", "depthplyenc", color_and_depth + "depthplyenc name=e calibration=%c" + out, 1},
    {"recording", "dffmetapay",
     "lenssweeptestsrc %s planes=3 ! video/x-raw,width=48,height=32 ! dffmetapay ! dffmetadepay" + out, 1},
    {"camera", "dffcamerabin",
     "dffcamerabin name=c source=\"lenssweeptestsrc planes=3 %s ! video/x-raw,width=64,height=64\"  "
     "c.depth ! queue ! appsink name=out sync=false max-buffers=4  c.aif ! queue ! fakesink",
     3},
};

unsigned scale(const char *variable, unsigned otherwise)
{
    const char *value = std::getenv(variable);
    return value ? static_cast<unsigned>(std::atoi(value)) : otherwise;
}

void replace_all(std::string &text, const std::string &mark, const std::string &value)
{
    for (size_t at = text.find(mark); at != std::string::npos; at = text.find(mark))
        text.replace(at, mark.size(), value);
}

class Endurance : public testing::TestWithParam<Chain> {
protected:
    void SetUp() override
    {
        gst_init(nullptr, nullptr);
        g_autoptr(GstElementFactory) factory = gst_element_factory_find(GetParam().element.c_str());
        if (!factory)
            GTEST_SKIP() << GetParam().element << " is not built";
        if (dff::is_sanitized())
            GTEST_SKIP() << "memory is the sanitizer's own";
        std::ofstream(calibration_) << "%YAML:1.0\n---\nimage_width: 48\nimage_height: 32\n"
                                       "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                                       "   data: [ 40., 0., 24., 0., 40., 16., 0., 0., 1. ]\n"
                                       "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n"
                                       "   dt: d\n   data: [ 0., 0., 0., 0., 0. ]\n";
    }

    void TearDown() override { unlink(calibration_.c_str()); }

    std::string pipeline(const std::string &properties) const
    {
        std::string text = GetParam().pipeline;
        replace_all(text, "%s", properties);
        replace_all(text, "%c", calibration_);
        return text;
    }

private:
    std::string calibration_ = testing::TempDir() + "endurance" + std::to_string(getpid()) + ".yml";
};

void start_and_stop(const std::string &description, unsigned cycles)
{
    TestPipeline pipeline(description);
    for (unsigned cycle = 0; cycle < cycles; cycle++) {
        pipeline.play();
        g_autoptr(GstSample) sample = pipeline.pull("out");
        ASSERT_NE(sample, nullptr) << "cycle " << cycle;
        pipeline.stop();
    }
}

} // namespace

TEST_P(Endurance, starts_and_stops_leave_no_object_behind)
{
    const std::string endless = pipeline("");
    start_and_stop(endless, 1); /* what is made once and for all: clocks, plug-ins, types */
    g_usleep(G_USEC_PER_SEC / 4);
    const auto before = dff::live_objects();
    const size_t memory = dff::resident_kib();
    start_and_stop(endless, scale("DFF_CYCLES", 4));
    for (const auto &[type, count] : dff::left_behind(before))
        ADD_FAILURE() << count << " " << type << " left behind";
    std::printf("resident before %zu KiB, after %zu KiB\n", memory, dff::resident_kib());
}

TEST_P(Endurance, memory_stays_flat)
{
    const unsigned frames = scale("DFF_FRAMES", 600), expected = frames / GetParam().frames_each;
    TestPipeline running(pipeline("num-buffers=" + std::to_string(frames)));
    running.play();
    unsigned count = 0;
    size_t early = 0;
    while (GstSample *sample = running.pull("out")) {
        gst_sample_unref(sample);
        if (++count == expected / 5)
            early = dff::resident_kib();
    }
    const size_t late = dff::resident_kib();
    EXPECT_EQ(count, expected);
    std::printf("resident after %u of %u frames %zu KiB, after all %zu KiB\n", expected / 5, expected, early,
                late);
    EXPECT_LT(late, early + 4096);
}

INSTANTIATE_TEST_SUITE_P(Chains, Endurance, testing::ValuesIn(chains),
                         [](const auto &instance) { return instance.param.name; });
