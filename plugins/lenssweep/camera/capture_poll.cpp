/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "capture_poll.h"

#include "camera_control.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <poll.h>
#include <sys/eventfd.h>
#include <system_error>
#include <unistd.h>

namespace dff {

namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

/* Deadlines may be for ever, which a timespec of a relative time need not hold. */
constexpr std::int64_t longest_wait_ns = 3600 * second_ns;

} // namespace

std::int64_t host_now_ns()
{
    return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

CapturePoll::CapturePoll() : woken_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))
{
    if (woken_ < 0)
        throw CameraError("cannot make an event descriptor: " + std::generic_category().message(errno));
}

CapturePoll::~CapturePoll()
{
    close(woken_);
}

void CapturePoll::wake() noexcept
{
    eventfd_write(woken_, 1);
}

void CapturePoll::wait(int descriptor, std::int64_t deadline_ns) noexcept
{
    const std::int64_t left_ns = std::clamp<std::int64_t>(deadline_ns - host_now_ns(), 0, longest_wait_ns);
    const timespec left{left_ns / second_ns, left_ns % second_ns};
    std::array<pollfd, 2> waited{{{woken_, POLLIN, 0}, {descriptor, POLLIN, 0}}};
    ppoll(waited.data(), waited.size(), &left, nullptr);
    eventfd_t wakes = 0;
    eventfd_read(woken_, &wakes);
}

} // namespace dff
