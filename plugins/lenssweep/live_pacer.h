/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <condition_variable>
#include <gst/gst.h>
#include <mutex>

/* Holds a live source's streaming thread back until its element plays and the clock has come so far. Every
 * wait can be ended from another thread. */
class LivePacer {
public:
    LivePacer() = default;
    LivePacer(const LivePacer &) = delete;
    LivePacer &operator=(const LivePacer &) = delete;
    ~LivePacer();

    void set_playing(bool playing);

    /* While flushing, every wait ends at once. */
    void set_flushing(bool flushing);

    /* False if flushing. */
    bool wait_until_playing();

    /* Waits for a running time of the element, through any number of pauses. False if flushing. */
    bool wait_until(GstElement *element, GstClockTime running_time);

private:
    void unschedule();
    bool wait_for(GstClockID wait);

    std::mutex mutex_; /* guards all below; taken without any other lock held */
    std::condition_variable changed_;
    bool playing_ = false;
    bool flushing_ = false;
    GstClockID wait_ = nullptr;
};
