/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace dff {

/* One end of a wire that a test can plug into: a Unix socket of packets at a path, each packet the text
 * "LEVEL TIME", LEVEL 0 or 1, TIME of the edge in nanoseconds of CLOCK_MONOTONIC. Whoever connects is on the
 * wire; who leaves lets go of it, and it falls to 0. */
class LineServer {
public:
    /* `on_level` hears of every change of the level that clients drive. Throws std::system_error. */
    LineServer(std::string path, std::function<void(bool)> on_level);
    ~LineServer();
    LineServer(const LineServer &) = delete;
    LineServer &operator=(const LineServer &) = delete;

    /* Tells the clients of an edge. */
    void send(bool level, uint64_t time_ns);

private:
    void serve(const std::stop_token &stop);
    void accept_clients();
    std::vector<int> clients();
    void read_client(int client);
    void set_level(bool level);

    std::string path_;
    std::function<void(bool)> on_level_;
    int listener_;
    bool level_ = false;       /* of the serving thread */
    std::mutex mutex_;         /* guards clients_; nothing is locked within */
    std::vector<int> clients_; /* closed by the serving thread only */
    std::jthread thread_;
};

} // namespace dff
