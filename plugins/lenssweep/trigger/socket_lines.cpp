/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "socket_lines.h"

#include "descriptor_wait.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <poll.h>
#include <string_view>
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

/* The wire to whoever listens at a path. */
class Wire {
public:
    explicit Wire(const std::string &path)
        : path_(path), socket_(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0))
    {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path.copy(static_cast<char *>(address.sun_path), sizeof address.sun_path - 1);
        if (socket_ < 0 || connect(socket_, reinterpret_cast<sockaddr *>(&address), sizeof address) < 0) {
            const std::string why = reason();
            close(socket_);
            throw LineError("cannot connect to the line at the socket \"" + path + "\": " + why +
                            ". The process at its other end must be started first");
        }
    }
    ~Wire() { close(socket_); }
    Wire(const Wire &) = delete;
    Wire &operator=(const Wire &) = delete;

    int descriptor() const { return socket_; }
    LineError cut() const { return LineError("the other end of the line \"" + path_ + "\" has gone"); }

private:
    std::string path_;
    int socket_;
};

class SocketOutputLine : public OutputLine {
public:
    explicit SocketOutputLine(const std::string &path) : wire_(path) {}

    void set(bool high) override
    {
        const auto now = std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch());
        const std::string packet = (high ? "1 " : "0 ") + std::to_string(now.count());
        if (send(wire_.descriptor(), packet.data(), packet.size(), MSG_NOSIGNAL) < 0) {
            throw wire_.cut();
        }
    }

private:
    Wire wire_;
};

class SocketEdgeLine : public EdgeLine {
public:
    explicit SocketEdgeLine(const std::string &path) : wire_(path) {}

    std::optional<LineEdge> wait(const std::stop_token &stop, std::chrono::nanoseconds timeout) override
    {
        const auto deadline = std::chrono::steady_clock::now() + timeout;
        for (auto left = timeout; woken_.wait(wire_.descriptor(), stop, left) != 0;
             left = deadline - std::chrono::steady_clock::now()) {
            if (const auto edge = read()) {
                return edge;
            }
        }
        return std::nullopt;
    }

private:
    /* Nothing for a falling edge. */
    std::optional<LineEdge> read() const
    {
        std::array<char, 64> packet{};
        const ssize_t size = recv(wire_.descriptor(), packet.data(), packet.size(), 0);
        if (size <= 0) {
            throw wire_.cut();
        }
        const std::string_view text(packet.data(), static_cast<size_t>(size));
        LineEdge edge{};
        const bool understood =
            text.size() > 2 && text[1] == ' ' &&
            std::from_chars(text.data() + 2, text.data() + text.size(), edge.time_ns).ec == std::errc();
        if (!understood) {
            throw LineError("the other end of a line sends \"" + std::string(text) + "\", not LEVEL TIME");
        }
        return text[0] == '1' ? std::optional(edge) : std::nullopt;
    }

    Wire wire_;
    DescriptorWait woken_;
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
