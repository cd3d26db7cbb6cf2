/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "proofs.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace dff;
using namespace std::chrono_literals;

namespace {

const std::string sink = " ! video/x-raw,format=GRAY8 ! appsink name=labels sync=false";

/* Sweeps in so many seconds. */
std::string sweeps(double seconds)
{
    return "--sweeps=" + std::to_string(static_cast<int>(seconds * 26.0));
}

std::chrono::milliseconds milliseconds(double seconds)
{
    return std::chrono::milliseconds(static_cast<int64_t>(seconds * 1e3));
}

/* Runs until the sequencer has made its sweeps, and prints what happened. */
void run_dry(WatchedStream &stream, double seconds)
{
    stream.play();
    EXPECT_TRUE(stream.wait_for_frames(1, 10s)) << stream.stats();
    EXPECT_FALSE(stream.wait_for_end(milliseconds(seconds)));
    stream.wait_for_silence(500ms);
    const Watched watched = stream.watched();
    std::printf("%lu frames, %lu unlabelled, %lu wrong\n%s\n", watched.frames, watched.unlabelled,
                watched.wrong, stream.stats().c_str());
    EXPECT_EQ(watched.wrong, 0U) << watched.first_wrong;
    /* Before the camera goes: to leave one that has gone takes Aravis some seconds. */
    stream.stop();
}

} // namespace

TEST(Labels, every_frame_of_a_good_camera_has_its_plane)
{
    const double seconds = seconds_of_proof(1.5);
    BenchProcess bench({"--size=640x480", sweeps(seconds)});
    WatchedStream stream(bench.source() + sink);
    run_dry(stream, seconds);
    expect_accounts_agree(stream, bench.stop());
}

TEST(Labels, lost_frames_are_counted_and_no_label_is_wrong)
{
    const double seconds = seconds_of_proof(2.0);
    BenchProcess bench({"--size=320x240", "--lose=~100", sweeps(seconds)});
    WatchedStream stream(bench.source() + sink);
    run_dry(stream, seconds);
    expect_accounts_agree(stream, bench.stop());
}

TEST(Labels, a_camera_that_misses_triggers_gets_no_wrong_label)
{
    const double seconds = seconds_of_proof(2.0);
    BenchProcess bench({"--size=320x240", "--ignore=~100", "--lose=~100", "--duplicate=~90", "--reorder=~110",
                        "--delay=~120", "--lose-sync=~20", "--clock-offset=-7000000000", "--clock-drift=50",
                        sweeps(seconds)});
    WatchedStream stream(bench.source() + sink);
    run_dry(stream, seconds);
    EXPECT_GT(stream.watched().frames, 100U);
}

TEST(Labels, triggers_may_pause)
{
    const double pause = std::min(10.0, seconds_of_proof(2.0));
    BenchProcess bench({"--size=320x240", "--pause=1:" + std::to_string(pause), "--sweeps=52"});
    WatchedStream stream(bench.source() + sink);
    run_dry(stream, pause + 2.0);
    expect_accounts_agree(stream, bench.stop());
}

TEST(Labels, a_lens_in_the_camera_is_stepped)
{
    BenchProcess bench({"--size=160x120", "--lens=register"});
    WatchedStream stream(bench.unwired_source() + " trigger=software lens=genicam:FocalPower rate=2" + sink);
    stream.play();
    EXPECT_TRUE(stream.wait_for_frames(24, 20s)) << stream.stats();
    stream.stop();
    const Watched watched = stream.watched();
    std::printf("stepped: %lu frames, %lu wrong\n%s\n", watched.frames, watched.wrong,
                stream.stats().c_str());
    EXPECT_EQ(watched.wrong, 0U) << watched.first_wrong;
}

/* Rendering its planes takes longer than a short proof may. DFF_RIG_RATE is the rate to try, in sweeps a
 * second. */
TEST(Labels, full_hd_at_the_rate_this_machine_holds)
{
    const double seconds = seconds_of_proof(0.0);
    if (seconds == 0.0)
        GTEST_SKIP() << "only with DFF_RIG_SECONDS";
    const int rate = rate_of_proof(10);
    const std::string option = "rate=" + std::to_string(rate);
    BenchProcess bench(
        {"--size=1920x1080", "--" + option, "--sweeps=" + std::to_string(static_cast<int>(seconds * rate))});
    WatchedStream stream(bench.source() + " " + option + sink);
    run_dry(stream, seconds);
    std::printf("1920x1080 at %d frames a second\n", 6 * rate);
    expect_accounts_agree(stream, bench.stop());
}
