/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "live_pacer.h"

LivePacer::~LivePacer()
{
    g_assert(!wait_);
}

void LivePacer::unschedule()
{
    if (wait_)
        gst_clock_id_unschedule(wait_);
}

void LivePacer::set_playing(bool playing)
{
    const std::lock_guard lock(mutex_);
    playing_ = playing;
    if (!playing)
        unschedule();
    changed_.notify_all();
}

void LivePacer::set_flushing(bool flushing)
{
    const std::lock_guard lock(mutex_);
    flushing_ = flushing;
    if (flushing)
        unschedule();
    changed_.notify_all();
}

bool LivePacer::wait_until_playing()
{
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return playing_ || flushing_; });
    return !flushing_;
}

bool LivePacer::wait_for(GstClockID wait)
{
    {
        const std::lock_guard lock(mutex_);
        if (!playing_ || flushing_)
            return false;
        wait_ = wait;
    }
    const GstClockReturn result = gst_clock_id_wait(wait, nullptr);
    const std::lock_guard lock(mutex_);
    wait_ = nullptr;
    return result != GST_CLOCK_UNSCHEDULED;
}

bool LivePacer::wait_until(GstElement *element, GstClockTime running_time)
{
    while (wait_until_playing()) {
        g_autoptr(GstClock) clock = gst_element_get_clock(element);
        if (!clock)
            return true;
        const GstClockTime base_time = gst_element_get_base_time(element);
        GstClockID wait = gst_clock_new_single_shot_id(clock, base_time + running_time);
        const bool reached = wait_for(wait);
        gst_clock_id_unref(wait);
        if (reached)
            return true;
    }
    return false;
}
