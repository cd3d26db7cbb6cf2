/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "socket_lines.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <sys/socket.h>
#include <sys/un.h>
#include <system_error>
#include <unistd.h>

namespace dff {

namespace {

std::string reason()
{
    return std::generic_category().message(errno);
}

/* The wire to whoever listens at a path. Nothing here waits for the other end: what it does not take at once
 * it will not take at all. */
class Wire {
public:
    explicit Wire(const std::string &path) : path_(path)
    {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        if (path.size() >= sizeof address.sun_path) {
            throw LineError("the path of the line at the socket \"" + path + "\" is too long: " +
                            std::to_string(sizeof address.sun_path - 1) + " characters at most");
        }
        path.copy(static_cast<char *>(address.sun_path), path.size());
        socket_ = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
        if (socket_ < 0 || connect(socket_, reinterpret_cast<sockaddr *>(&address), sizeof address) < 0) {
            const std::string why = reason();
            if (socket_ >= 0) {
                close(socket_);
            }
            throw LineError("cannot connect to the line at the socket \"" + path + "\": " + why +
                            ". The process at its other end must be started first");
        }
    }
    ~Wire() { close(socket_); }
    Wire(const Wire &) = delete;
    Wire &operator=(const Wire &) = delete;

    int descriptor() const { return socket_; }

    void send(const std::string &packet) const
    {
        if (::send(socket_, packet.data(), packet.size(), MSG_NOSIGNAL) >= 0) {
            return;
        }
        if (errno == EAGAIN) {
            throw LineError("the other end of the line \"" + path_ + "\" does not read what it is sent");
        }
        throw cut();
    }

    /* Nothing if no packet has come. */
    std::optional<std::string> receive() const
    {
        std::array<char, 64> packet{};
        const ssize_t size = recv(socket_, packet.data(), packet.size(), 0);
        if (size < 0 && errno == EAGAIN) {
            return std::nullopt;
        }
        if (size <= 0) {
            throw cut();
        }
        return std::string(packet.data(), static_cast<std::size_t>(size));
    }

private:
    LineError cut() const { return LineError("the other end of the line \"" + path_ + "\" has gone"); }

    std::string path_;
    int socket_ = -1;
};

class SocketOutputLine : public OutputLine {
public:
    explicit SocketOutputLine(const std::string &path) : wire_(path) {}

    void set(bool high) override
    {
        const auto now = std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch());
        wire_.send((high ? "1 " : "0 ") + std::to_string(now.count()));
    }

private:
    Wire wire_;
};

/* Nothing for a falling edge. */
std::optional<LineEdge> edge_of(const std::string &packet)
{
    LineEdge edge{};
    const char *const end = packet.data() + packet.size();
    const bool understood = packet.size() > 2 && packet[1] == ' ' &&
                            std::from_chars(packet.data() + 2, end, edge.time_ns).ec == std::errc();
    if (!understood) {
        throw LineError("the other end of a line sends \"" + packet + "\", not LEVEL TIME");
    }
    return packet[0] == '1' ? std::optional(edge) : std::nullopt;
}

class SocketEdgeLine : public EdgeLine {
public:
    explicit SocketEdgeLine(const std::string &path) : wire_(path) {}

    int descriptor() const override { return wire_.descriptor(); }

    std::optional<LineEdge> read() override
    {
        while (const auto packet = wire_.receive()) {
            if (const auto edge = edge_of(*packet)) {
                return edge;
            }
        }
        return std::nullopt;
    }

private:
    Wire wire_;
};

} // namespace

std::unique_ptr<OutputLine> open_socket_output_line(const std::string &path)
{
    return std::make_unique<SocketOutputLine>(path);
}

std::unique_ptr<EdgeLine> open_socket_edge_line(const std::string &path)
{
    return std::make_unique<SocketEdgeLine>(path);
}

} // namespace dff
