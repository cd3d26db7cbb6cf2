/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "next_edge.h"
#include "rig.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace std::chrono_literals;

namespace {

uint64_t now_ns()
{
    return static_cast<uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
}

bool is_free(const std::string &name)
{
    try {
        dff::open_edge_line(name);
        return true;
    } catch (const dff::LineError &) {
        return false;
    }
}

/* The simulated chip passes an edge on a little later, and two as one if they come too fast. */
void pulse()
{
    rig::pull(rig::sync_line, true);
    std::this_thread::sleep_for(5ms);
    rig::pull(rig::sync_line, false);
    std::this_thread::sleep_for(5ms);
}

} // namespace

TEST(RunLine, is_raised_and_is_low_when_it_is_let_go)
{
    {
        const auto run = dff::open_output_line("RUN");
        EXPECT_FALSE(rig::level(rig::run_line));
        run->set(true);
        EXPECT_TRUE(rig::level(rig::run_line));
        run->set(false);
        EXPECT_FALSE(rig::level(rig::run_line));
        run->set(true);
    }
    EXPECT_FALSE(rig::level(rig::run_line));
    EXPECT_TRUE(is_free("RUN"));
}

TEST(Lines, are_called_by_name_or_by_chip_and_offset)
{
    for (const std::string &name :
         {std::string("RUN"), rig::variable("RIG_CHIP") + ":0", "/dev/" + rig::variable("RIG_CHIP") + ":0"}) {
        dff::open_output_line(name)->set(true);
        EXPECT_TRUE(is_free(name));
    }
    EXPECT_THROW(dff::open_output_line(rig::variable("RIG_CHIP") + ":8"), dff::LineError);
}

TEST(Lines, one_that_somebody_else_has_is_an_error_that_says_so)
{
    const auto run = dff::open_output_line("RUN");
    try {
        dff::open_edge_line("RUN");
        FAIL() << "taken twice";
    } catch (const dff::LineError &error) {
        EXPECT_NE(std::string(error.what()).find("Somebody else"), std::string::npos) << error.what();
    }
}

TEST(Lines, are_free_after_the_program_was_killed)
{
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
        const auto run = dff::open_output_line("RUN");
        const auto sync = dff::open_edge_line("SYNC");
        run->set(true);
        [[maybe_unused]] const auto written = write(ready[1], "", 1);
        pause();
        _exit(0);
    }
    char byte = 0;
    ASSERT_EQ(read(ready[0], &byte, 1), 1);
    EXPECT_FALSE(is_free("RUN"));
    EXPECT_FALSE(is_free("SYNC"));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_TRUE(is_free("RUN"));
    EXPECT_TRUE(is_free("SYNC"));
    close(ready[0]);
    close(ready[1]);
}

TEST(SyncLine, each_rising_edge_is_read_once_with_the_kernels_time)
{
    rig::pull(rig::sync_line, false);
    const auto sync = dff::open_edge_line("SYNC");
    for (int i = 0; i < 10; ++i) {
        const uint64_t before = now_ns();
        pulse();
        const auto edge = next_edge(*sync, 5s);
        ASSERT_TRUE(edge) << i;
        EXPECT_GE(edge->time_ns, before);
        EXPECT_LE(edge->time_ns, now_ns());
    }
    EXPECT_FALSE(next_edge(*sync, 20ms));
}

TEST(SyncLine, edges_that_nobody_read_in_time_are_lost_but_later_ones_come)
{
    const auto sync = dff::open_edge_line("SYNC");
    for (int i = 0; i < 40; ++i)
        pulse();
    int kept = 0;
    while (next_edge(*sync, 0s))
        ++kept;
    EXPECT_LE(kept, 16);
    EXPECT_GE(kept, 1);
    pulse();
    EXPECT_TRUE(next_edge(*sync, 5s));
}
