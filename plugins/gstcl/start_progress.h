/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <condition_variable>
#include <gst/gst.h>
#include <stop_token>
#include <thread>

namespace dff {

/* While it lives, an element computes its first stack. If that takes over a second, a progress message
 * ("kernels") tells the application what it waits for, and another one when it is over. */
class StartProgress {
public:
    explicit StartProgress(GstElement *element);
    ~StartProgress();

    StartProgress(const StartProgress &) = delete;
    StartProgress &operator=(const StartProgress &) = delete;

private:
    void wait(const std::stop_token &stop);

    GstElement *element_; /* which owns this */
    std::mutex mutex_;    /* guards nothing: what condition_variable_any waits with */
    std::condition_variable_any over_;
    bool has_told_ = false; /* the thread's own, until it has ended */
    std::jthread thread_;
};

} // namespace dff
