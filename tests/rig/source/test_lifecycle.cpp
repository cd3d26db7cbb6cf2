/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "proofs.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

using namespace dff;
using namespace std::chrono_literals;

namespace {

const std::string sink = " ! video/x-raw,format=GRAY8 ! appsink name=labels sync=false";

size_t entries(const char *folder)
{
    const std::filesystem::directory_iterator begin(folder);
    return static_cast<size_t>(std::distance(begin, std::filesystem::directory_iterator()));
}

/* Kilobytes of this process in memory. */
long resident()
{
    long pages = 0;
    std::ifstream statm("/proc/self/statm");
    statm >> pages >> pages;
    return pages * (sysconf(_SC_PAGESIZE) / 1024);
}

/* Starts and stops it, with a sweep in between each time; nothing may be left behind. */
void start_and_stop(WatchedStream &stream, int cycles)
{
    size_t threads = 0;
    size_t files = 0;
    long memory = 0;
    for (int cycle = 0; cycle < cycles; cycle++) {
        const uint64_t before = stream.watched().frames;
        stream.play();
        ASSERT_TRUE(stream.wait_for_frames(before + 6, 20s)) << "cycle " << cycle << ' ' << stream.stats();
        stream.stop();
        /* What GStreamer and GLib keep for good is there after the first. */
        if (cycle == 1) {
            threads = entries("/proc/self/task");
            files = entries("/proc/self/fd");
            memory = resident();
        }
    }
    std::printf(
        "%d cycles, %lu frames, %lu wrong; threads %zu to %zu, files %zu to %zu, resident %ld to %ld kB\n",
        cycles, stream.watched().frames, stream.watched().wrong, threads, entries("/proc/self/task"), files,
        entries("/proc/self/fd"), memory, resident());
    EXPECT_EQ(stream.watched().wrong, 0U) << stream.watched().first_wrong;
    EXPECT_LE(entries("/proc/self/task"), threads);
    EXPECT_LE(entries("/proc/self/fd"), files);
}

} // namespace

TEST(Lifecycle, a_source_that_waits_for_triggers_stops_at_once)
{
    BenchProcess bench({"--size=320x240", "--sweeps=2"});
    WatchedStream stream(bench.source() + sink);
    stream.play();
    ASSERT_TRUE(stream.wait_for_frames(6, 10s)) << stream.stats();
    stream.wait_for_silence(300ms);
    const auto begin = std::chrono::steady_clock::now();
    stream.stop();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 2s);
}

TEST(Lifecycle, starting_and_stopping_leaves_nothing_behind)
{
    BenchProcess bench({"--size=160x120"});
    WatchedStream stream(bench.source() + sink);
    start_and_stop(stream, cycles_of_proof(5));
}

TEST(Lifecycle, starting_and_stopping_with_a_lens_in_the_camera_leaves_nothing_behind)
{
    BenchProcess bench({"--size=160x120", "--lens=register"});
    WatchedStream stream(bench.unwired_source() + " trigger=software rate=4 lens=genicam:FocalPower" + sink);
    start_and_stop(stream, cycles_of_proof(3));
}

TEST(Lifecycle, a_camera_that_is_unplugged_is_an_error_and_can_come_back)
{
    BenchProcess bench({"--size=160x120"});
    WatchedStream stream(bench.source() + sink);
    stream.play();
    ASSERT_TRUE(stream.wait_for_frames(30, 10s)) << stream.stats();
    bench.kill();
    const auto end = stream.wait_for_end(30s);
    ASSERT_TRUE(end) << "neither error nor end";
    std::printf("unplugged: %s\n", end->c_str());
    stream.stop();

    bench.start();
    WatchedStream again(bench.source() + sink);
    again.play();
    EXPECT_TRUE(again.wait_for_frames(30, 10s)) << again.stats();
    EXPECT_EQ(stream.watched().wrong + again.watched().wrong, 0U);
}

/* The camera is asked for a frame, and not asked any more whether it is there. */
TEST(Lifecycle, a_camera_that_is_unplugged_while_it_is_triggered_by_command_says_what_it_says_otherwise)
{
    BenchProcess bench({"--size=160x120", "--lens=register"});
    WatchedStream stream(bench.unwired_source() + " trigger=software rate=2 lens=genicam:FocalPower" + sink);
    stream.play();
    ASSERT_TRUE(stream.wait_for_frames(6, 20s)) << stream.stats();
    bench.kill();
    const auto end = stream.wait_for_end(30s);
    ASSERT_TRUE(end) << "neither error nor end";
    EXPECT_NE(end->find("The camera does not answer any more"), std::string::npos) << *end;
    stream.stop();

    bench.start();
    stream.play();
    EXPECT_TRUE(stream.wait_for_frames(stream.watched().frames + 6, 20s)) << stream.stats();
    EXPECT_EQ(stream.watched().wrong, 0U) << stream.watched().first_wrong;
}

/* Its first frame after each start may pass for plane 0. */
TEST(Lifecycle, a_camera_that_heeds_no_trigger_is_an_error_and_does_not_begin_anew_for_ever)
{
    BenchProcess bench({"--size=160x120", "--planes=2", "--rate=4"});
    WatchedStream stream(bench.source() +
                         " camera=Fake_1 sync-line=\"\" planes=2 rate=4 ! appsink name=labels sync=false");
    stream.play();
    const auto end = stream.wait_for_end(30s);
    ASSERT_TRUE(end) << stream.stats();
    EXPECT_NE(end->find("trigger=free-run"), std::string::npos) << *end;
}

TEST(Lifecycle, a_camera_that_another_program_controls_is_an_error_and_its_stream_goes_on)
{
    BenchProcess bench({"--size=160x120"});
    WatchedStream first(bench.source() + sink);
    first.play();
    ASSERT_TRUE(first.wait_for_frames(30, 10s)) << first.stats();
    WatchedStream second(bench.unwired_source() + " trigger=free-run" + sink);
    gst_element_set_state(second.pipeline(), GST_STATE_PLAYING);
    const auto end = second.wait_for_end(20s);
    ASSERT_TRUE(end) << "neither error nor end";
    EXPECT_NE(end->find("another program"), std::string::npos) << *end;
    EXPECT_TRUE(first.wait_for_frames(first.watched().frames + 30, 10s)) << first.stats();
    EXPECT_EQ(first.watched().wrong, 0U) << first.watched().first_wrong;
}
