/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>
#include <thread>

/* Sets a capsfilter to another width just before the next caps come to it, from a thread that is held up
 * before it tells the source: the worst moment there is. Caps are refused then by what had just said that it
 * takes them. */
class FickleFilter {
public:
    /* The filter must outlive this and have a width in its caps. */
    FickleFilter(GstElement *filter, int width);
    ~FickleFilter();
    FickleFilter(const FickleFilter &) = delete;
    FickleFilter &operator=(const FickleFilter &) = delete;

private:
    int present_width() const;
    static GstPadProbeReturn at_event(GstPad *pad, GstPadProbeInfo *info, gpointer self);
    static GstPadProbeReturn hold_up(GstPad *pad, GstPadProbeInfo *info, gpointer self);

    GstElement *filter_;
    int width_;
    std::thread changes_;
};
