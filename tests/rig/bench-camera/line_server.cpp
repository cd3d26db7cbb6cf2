/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "line_server.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <system_error>
#include <unistd.h>

namespace dff {

namespace {

constexpr int poll_ms = 20;

int listen_at(const std::string &path)
{
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path)
        throw std::system_error(ENAMETOOLONG, std::generic_category(), path);
    std::memcpy(address.sun_path, path.data(), path.size());
    unlink(path.c_str());
    const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd < 0 || bind(fd, reinterpret_cast<sockaddr *>(&address), sizeof address) != 0 ||
        listen(fd, 4) != 0) {
        const int error = errno;
        close(fd);
        throw std::system_error(error, std::generic_category(), path);
    }
    return fd;
}

} // namespace

LineServer::LineServer(std::string path, std::function<void(bool)> on_level)
    : path_(std::move(path)), on_level_(std::move(on_level)), listener_(listen_at(path_)),
      thread_([this](const std::stop_token &stop) { serve(stop); })
{
}

LineServer::~LineServer()
{
    thread_.request_stop();
    thread_.join();
    for (const int fd : clients_)
        close(fd);
    close(listener_);
    unlink(path_.c_str());
}

void LineServer::send(bool level, uint64_t time_ns)
{
    const std::string message = std::to_string(level ? 1 : 0) + ' ' + std::to_string(time_ns);
    /* Who has connected before an edge hears it. */
    accept_clients();
    const std::scoped_lock lock(mutex_);
    /* A client that does not listen loses edges, as it would from the kernel. */
    for (const int fd : clients_)
        ::send(fd, message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

void LineServer::set_level(bool level)
{
    if (level_ == level)
        return;
    level_ = level;
    on_level_(level);
}

void LineServer::accept_clients()
{
    const std::scoped_lock lock(mutex_);
    for (int fd = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC); fd >= 0;
         fd = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC))
        clients_.push_back(fd);
}

std::vector<int> LineServer::clients()
{
    const std::scoped_lock lock(mutex_);
    return clients_;
}

void LineServer::read_client(int client)
{
    std::array<char, 64> message{};
    if (recv(client, message.data(), message.size() - 1, MSG_DONTWAIT) > 0) {
        set_level(message[0] == '1');
        return;
    }
    set_level(false);
    const std::scoped_lock lock(mutex_);
    std::erase(clients_, client);
    close(client);
}

void LineServer::serve(const std::stop_token &stop)
{
    while (!stop.stop_requested()) {
        std::vector<pollfd> waiting;
        for (const int fd : clients())
            waiting.push_back({fd, POLLIN, 0});
        waiting.push_back({listener_, POLLIN, 0});
        if (poll(waiting.data(), waiting.size(), poll_ms) <= 0)
            continue;
        if (waiting.back().revents != 0)
            accept_clients();
        waiting.pop_back();
        for (const pollfd &client : waiting)
            if (client.revents != 0)
                read_client(client.fd);
    }
}

} // namespace dff
