/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "line_server.h"
#include "next_edge.h"

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <gtest/gtest.h>
#include <memory>
#include <mutex>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <vector>

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

/* Somebody who listens there, and does nothing else. */
int listen_at(const std::filesystem::path &path)
{
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.string().copy(static_cast<char *>(address.sun_path), sizeof address.sun_path - 1);
    const int listener = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    EXPECT_EQ(bind(listener, reinterpret_cast<sockaddr *>(&address), sizeof address), 0);
    EXPECT_EQ(listen(listener, 1), 0);
    return listener;
}

} // namespace

TEST_F(SocketLines, edges_come_with_the_times_the_other_end_gave_them)
{
    const auto line = dff::open_edge_line(name());
    server_->send(true, 1'000'000'007);
    const auto first = next_edge(*line, 5s);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->time_ns, 1'000'000'007U);
    server_->send(false, 1'500'000'000); /* falling edges are nobody's */
    server_->send(true, 2'000'000'000);
    const auto second = next_edge(*line, 5s);
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

TEST_F(SocketLines, reading_without_an_edge_does_not_wait)
{
    const auto line = dff::open_edge_line(name());
    EXPECT_FALSE(line->read());
    server_->send(false, 1);
    EXPECT_FALSE(next_edge(*line, 20ms));
}

/* Nobody who drives a line may be held up by who is at its other end. */
TEST(SocketLinesWithoutReader, an_output_that_nobody_reads_is_an_error_and_not_a_wait)
{
    std::string folder = std::filesystem::temp_directory_path() / "dff-line-XXXXXX";
    const std::filesystem::path path = std::filesystem::path(mkdtemp(folder.data())) / "line";
    const int listener = listen_at(path);
    const auto line = dff::open_output_line("socket:" + path.string());
    auto driven = std::async(std::launch::async, [&line] {
        for (int i = 0; i < 100'000; i++)
            line->set(i % 2 == 0);
    });
    const bool returned = driven.wait_for(10s) == std::future_status::ready;
    close(listener); /* ends a wait, if there is one */
    EXPECT_TRUE(returned);
    EXPECT_THROW(driven.get(), dff::LineError);
    std::filesystem::remove_all(folder);
}

/* The backlog of a process that does not accept fills up. */
TEST(SocketLinesWithoutReader, a_line_that_nobody_accepts_is_an_error_and_not_a_wait)
{
    std::string folder = std::filesystem::temp_directory_path() / "dff-line-XXXXXX";
    const std::filesystem::path path = std::filesystem::path(mkdtemp(folder.data())) / "line";
    const int listener = listen_at(path);
    auto opened = std::async(std::launch::async, [&path] {
        std::vector<std::unique_ptr<dff::OutputLine>> lines;
        for (int i = 0; i < 100; i++)
            lines.push_back(dff::open_output_line("socket:" + path.string()));
    });
    const bool returned = opened.wait_for(10s) == std::future_status::ready;
    close(listener);
    EXPECT_TRUE(returned);
    EXPECT_THROW(opened.get(), dff::LineError);
    std::filesystem::remove_all(folder);
}

TEST(SocketLinesWithoutReader, a_path_that_is_too_long_is_an_error_that_says_so)
{
    try {
        dff::open_edge_line("socket:/tmp/" + std::string(200, 'x'));
        FAIL() << "opened";
    } catch (const dff::LineError &error) {
        EXPECT_NE(std::string(error.what()).find("107 characters"), std::string::npos) << error.what();
    }
}

TEST_F(SocketLines, a_line_whose_other_end_has_gone_is_an_error)
{
    const auto input = dff::open_edge_line(name());
    const auto output = dff::open_output_line(name());
    server_.reset();
    EXPECT_THROW(next_edge(*input, 5s), dff::LineError);
    EXPECT_THROW(output->set(true), dff::LineError);
    EXPECT_THROW(dff::open_output_line(name()), dff::LineError);
}
