/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "server_process.h"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <unistd.h>

ServerProcess::ServerProcess(const std::string &launch, const std::vector<std::string> &arguments)
{
    std::vector<const char *> command = {
        std::getenv("DFF_RTSP_SERVER"), "--address", "127.0.0.1", "--port", "0", "--launch", launch.c_str()};
    for (const std::string &argument : arguments)
        command.push_back(argument.c_str());
    command.push_back(nullptr);

    char name[] = "dff-rtsp-server-XXXXXX.log";
    g_autofree char *path = g_build_filename(g_get_tmp_dir(), name, nullptr);
    close(g_mkstemp(path));
    log_path_ = path;
    g_autoptr(GSubprocessLauncher) launcher = g_subprocess_launcher_new(G_SUBPROCESS_FLAGS_STDOUT_PIPE);
    g_subprocess_launcher_set_stderr_file_path(launcher, path);
    g_autoptr(GError) error = nullptr;
    process_ = g_subprocess_launcher_spawnv(launcher, command.data(), &error);
    if (!process_)
        throw std::runtime_error(error->message);

    g_autoptr(GDataInputStream) out = g_data_input_stream_new(g_subprocess_get_stdout_pipe(process_));
    g_autofree char *line = g_data_input_stream_read_line(out, nullptr, nullptr, nullptr);
    if (!line)
        throw std::runtime_error("dff-rtsp-server did not start");
    origin_ = line;
    origin_ = origin_.substr(0, origin_.rfind('/'));
}

ServerProcess::~ServerProcess()
{
    g_subprocess_send_signal(process_, SIGTERM);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (g_subprocess_get_identifier(process_) && std::chrono::steady_clock::now() < deadline)
        g_main_context_iteration(nullptr, FALSE);
    g_subprocess_force_exit(process_);
    g_subprocess_wait(process_, nullptr, nullptr);
    const bool ended_well =
        g_subprocess_get_if_exited(process_) && g_subprocess_get_exit_status(process_) == 0;
    std::ifstream log(log_path_);
    EXPECT_TRUE(ended_well) << log.rdbuf();
    g_object_unref(process_);
    std::remove(log_path_.c_str());
}

std::string ServerProcess::url(const std::string &path, const std::string &account) const
{
    std::string origin = origin_;
    if (!account.empty())
        origin.insert(origin.find("://") + 3, account + "@");
    return origin + path;
}

unsigned ServerProcess::count_in_log(const std::string &text) const
{
    std::stringstream log;
    log << std::ifstream(log_path_).rdbuf();
    unsigned count = 0;
    for (size_t at = log.str().find(text); at != std::string::npos; at = log.str().find(text, at + 1))
        count++;
    return count;
}

bool ServerProcess::wait_for_log(const std::string &text, unsigned times) const
{
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (count_in_log(text) < times && std::chrono::steady_clock::now() < deadline)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return count_in_log(text) >= times;
}
