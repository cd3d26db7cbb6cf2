/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "descriptor_wait.h"

#include "lines.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <poll.h>
#include <sys/eventfd.h>
#include <system_error>
#include <unistd.h>

namespace dff {

namespace {

/* The millisecond count that poll() takes holds it. */
constexpr std::chrono::nanoseconds longest_wait = std::chrono::hours{24};

} // namespace

DescriptorWait::DescriptorWait() : stopped_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))
{
    if (stopped_ < 0) {
        throw LineError("cannot make an event descriptor: " + std::generic_category().message(errno));
    }
}

DescriptorWait::~DescriptorWait()
{
    close(stopped_);
}

short DescriptorWait::wait(int descriptor, const std::stop_token &stop,
                           std::chrono::nanoseconds timeout) const
{
    eventfd_t left_over = 0;
    eventfd_read(stopped_, &left_over);
    const std::stop_callback wake(stop, [this] { eventfd_write(stopped_, 1); });
    std::array<pollfd, 2> waited{{{descriptor, POLLIN, 0}, {stopped_, POLLIN, 0}}};
    const auto deadline = std::chrono::steady_clock::now() + std::min(timeout, longest_wait);
    int ready = 0;
    do {
        const auto left =
            std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
        ready = poll(waited.data(), waited.size(), std::max(0, static_cast<int>(left.count())));
    } while (ready < 0 && errno == EINTR);
    if (ready < 0) {
        return POLLERR;
    }
    return stop.stop_requested() ? short{0} : waited[0].revents;
}

} // namespace dff
