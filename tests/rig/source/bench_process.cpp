/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "bench_process.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <opencv2/core.hpp>
#include <poll.h>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace dff {

namespace {

constexpr int patience_ms = 60'000;

/* The one that was built with this test, unless the environment knows another. */
const char *bench_camera()
{
    const char *other = std::getenv("BENCH_CAMERA");
    return other ? other : BENCH_CAMERA;
}

} // namespace

BenchProcess::BenchProcess(const std::vector<std::string> &options)
{
    std::string folder = std::filesystem::temp_directory_path() / "dff-rig-XXXXXX";
    folder_ = mkdtemp(folder.data());
    options_ = {bench_camera(), "--stamp", "--run-line=" + (folder_ / "run").string(),
                "--sync-line=" + (folder_ / "sync").string(), "--truth=" + truth()};
    options_.insert(options_.end(), options.begin(), options.end());
    start();
}

BenchProcess::~BenchProcess()
{
    kill();
    std::filesystem::remove_all(folder_);
}

std::string BenchProcess::unwired_source() const
{
    return "lenssweepsrc name=source camera=127.0.0.1";
}

std::string BenchProcess::source() const
{
    return unwired_source() + " run-line=socket:" + (folder_ / "run").string() +
           " sync-line=socket:" + (folder_ / "sync").string();
}

void BenchProcess::start()
{
    std::array<int, 2> pipe_ends{};
    if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0)
        throw std::runtime_error("no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], STDOUT_FILENO);
    std::vector<char *> arguments;
    for (std::string &option : options_)
        arguments.push_back(option.data());
    arguments.push_back(nullptr);
    const int error = posix_spawn(&pid_, bench_camera(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(pipe_ends[1]);
    output_ = pipe_ends[0];
    if (error != 0)
        throw std::runtime_error("the bench camera cannot be started");
    if (const std::string line = read_line(); line != "ready")
        throw std::runtime_error("the bench camera does not start: " + line);
}

std::string BenchProcess::read_line() const
{
    std::string line;
    pollfd waited{output_, POLLIN, 0};
    char c = 0;
    while (poll(&waited, 1, patience_ms) > 0 && read(output_, &c, 1) == 1 && c != '\n')
        line += c;
    return line;
}

void BenchProcess::end(int signal)
{
    if (pid_ != 0)
        ::kill(pid_, signal);
}

void BenchProcess::kill()
{
    end(SIGKILL);
    if (pid_ != 0)
        waitpid(pid_, nullptr, 0);
    close(output_);
    pid_ = 0;
    output_ = -1;
}

BenchProcess::Counts BenchProcess::stop()
{
    end(SIGTERM);
    const std::string report = read_line();
    kill();
    Counts counts;
    const cv::FileStorage parsed(report, cv::FileStorage::READ | cv::FileStorage::MEMORY |
                                             cv::FileStorage::FORMAT_JSON);
    for (const auto &node : parsed.root())
        if (node.isInt())
            counts[node.name()] = static_cast<int>(node);
    return counts;
}

} // namespace dff
