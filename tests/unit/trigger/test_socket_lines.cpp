/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lenssweep/trigger/lines.h"
#include "line_server.h"

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <memory>
#include <mutex>
#include <thread>

using namespace std::chrono_literals;

namespace {

/* The other end of a line, in a folder of its own. */
class SocketLines : public testing::Test {
protected:
    SocketLines()
    {
        std::string folder = std::filesystem::temp_directory_path() / "dff-line-XXXXXX";
        folder_ = mkdtemp(folder.data());
        server_ = std::make_unique<dff::LineServer>(path(), [this](bool level) {
            const std::scoped_lock lock(mutex_);
            level_ = level;
            changed_.notify_all();
        });
    }
    ~SocketLines() override
    {
        server_.reset();
        std::filesystem::remove_all(folder_);
    }

    std::string path() const { return folder_ / "line"; }
    std::string name() const { return "socket:" + path(); }

    bool becomes(bool level)
    {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, 5s, [&] { return level_ == level; });
    }

    std::filesystem::path folder_;
    std::unique_ptr<dff::LineServer> server_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool level_ = false;
};

} // namespace

TEST_F(SocketLines, edges_come_with_the_times_the_other_end_gave_them)
{
    const auto line = dff::open_edge_line(name());
    server_->send(true, 1'000'000'007);
    const auto first = line->wait({}, 5s);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->time_ns, 1'000'000'007U);
    server_->send(false, 1'500'000'000); /* falling edges are nobody's */
    server_->send(true, 2'000'000'000);
    const auto second = line->wait({}, 5s);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->time_ns, 2'000'000'000U);
}

TEST_F(SocketLines, an_output_falls_when_it_is_given_back)
{
    auto line = dff::open_output_line(name());
    line->set(true);
    EXPECT_TRUE(becomes(true));
    line->set(false);
    EXPECT_TRUE(becomes(false));
    line->set(true);
    EXPECT_TRUE(becomes(true));
    line.reset();
    EXPECT_TRUE(becomes(false));
}

TEST_F(SocketLines, waiting_ends_when_time_is_up_or_it_is_told_to)
{
    const auto line = dff::open_edge_line(name());
    EXPECT_FALSE(line->wait({}, 20ms));
    std::stop_source stop;
    const std::jthread stopper([&] {
        std::this_thread::sleep_for(50ms);
        stop.request_stop();
    });
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_FALSE(line->wait(stop.get_token(), 10s));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s);
}

TEST_F(SocketLines, a_line_whose_other_end_has_gone_is_an_error)
{
    const auto input = dff::open_edge_line(name());
    const auto output = dff::open_output_line(name());
    server_.reset();
    EXPECT_THROW(input->wait({}, 5s), dff::LineError);
    EXPECT_THROW(output->set(true), dff::LineError);
    EXPECT_THROW(dff::open_output_line(name()), dff::LineError);
}
