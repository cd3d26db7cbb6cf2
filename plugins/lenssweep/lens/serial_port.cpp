/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "serial_port.h"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <system_error>
#include <termios.h>
#include <unistd.h>

namespace dff {

namespace {

constexpr std::chrono::milliseconds longest_write{500};

std::string reason()
{
    return std::generic_category().message(errno);
}

bool set_up(int descriptor)
{
    termios settings{};
    if (ioctl(descriptor, TIOCEXCL) < 0 || tcgetattr(descriptor, &settings) < 0)
        return false;
    cfmakeraw(&settings);
    settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
    settings.c_cflag |= CLOCAL | CREAD;
    return cfsetspeed(&settings, B115200) == 0 && tcsetattr(descriptor, TCSANOW, &settings) == 0 &&
           tcflush(descriptor, TCIOFLUSH) == 0;
}

} // namespace

SerialPort::SerialPort(std::string device)
    : device_(std::move(device)),
      descriptor_(open(device_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC))
{
    if (descriptor_ < 0)
        throw LensError(
            "cannot open the serial port " + device_ + ": " + reason() +
            ". ls /dev/ttyACM* shows those there are; you may have to belong to the group dialout, "
            "and no other program may have it open");
    if (!set_up(descriptor_)) {
        const std::string why = reason();
        close(descriptor_);
        throw LensError(device_ + " is no serial port that can be used: " + why);
    }
}

SerialPort::~SerialPort()
{
    ioctl(descriptor_, TIOCNXCL);
    close(descriptor_);
}

void SerialPort::fail(const std::string &what) const
{
    throw LensError("the serial port " + device_ + " " + what +
                    ": has it been unplugged? Plug it in and start the pipeline again");
}

bool SerialPort::wait(short events, std::chrono::steady_clock::time_point deadline)
{
    pollfd ready{descriptor_, events, 0};
    int result = 0;
    do {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
            deadline - std::chrono::steady_clock::now() + std::chrono::microseconds{999});
        result = poll(&ready, 1, static_cast<int>(std::max<std::chrono::milliseconds::rep>(left.count(), 0)));
    } while (result < 0 && errno == EINTR);
    if (result > 0 && !(ready.revents & events))
        fail("is gone");
    return result > 0;
}

void SerialPort::write(std::span<const std::uint8_t> bytes)
{
    const auto deadline = std::chrono::steady_clock::now() + longest_write;
    while (!bytes.empty()) {
        if (!wait(POLLOUT, deadline))
            fail("takes no bytes");
        const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
        if (count < 0 && errno != EAGAIN && errno != EINTR)
            fail("cannot be written to (" + reason() + ")");
        bytes = bytes.subspan(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
}

std::vector<std::uint8_t> SerialPort::read(std::size_t count, std::chrono::milliseconds patience)
{
    const auto deadline = std::chrono::steady_clock::now() + patience;
    std::vector<std::uint8_t> bytes;
    while (bytes.size() < count && wait(POLLIN, deadline)) {
        std::uint8_t part[256];
        const ssize_t came = ::read(descriptor_, part, std::min(sizeof part, count - bytes.size()));
        if (came == 0 || (came < 0 && errno != EAGAIN && errno != EINTR))
            fail(came == 0 ? "is gone" : "cannot be read (" + reason() + ")");
        bytes.insert(bytes.end(), part, part + std::max<ssize_t>(came, 0));
    }
    return bytes;
}

void SerialPort::forget_input()
{
    tcflush(descriptor_, TCIFLUSH);
}

} // namespace dff
