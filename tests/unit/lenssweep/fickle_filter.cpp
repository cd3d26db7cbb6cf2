/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fickle_filter.h"

#include <chrono>

FickleFilter::FickleFilter(GstElement *filter, int width) : filter_(filter), width_(width)
{
    g_autoptr(GstPad) pad = gst_element_get_static_pad(filter, "sink");
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, &FickleFilter::at_event, this, nullptr);
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_EVENT_UPSTREAM, &FickleFilter::hold_up, nullptr, nullptr);
}

FickleFilter::~FickleFilter()
{
    if (changes_.joinable())
        changes_.join();
}

int FickleFilter::present_width() const
{
    g_autoptr(GstCaps) caps = nullptr;
    g_object_get(filter_, "caps", &caps, nullptr);
    int width = 0;
    gst_structure_get_int(gst_caps_get_structure(caps, 0), "width", &width);
    return width;
}

GstPadProbeReturn FickleFilter::at_event(GstPad *, GstPadProbeInfo *info, gpointer user_data)
{
    auto *self = static_cast<FickleFilter *>(user_data);
    if (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) != GST_EVENT_CAPS)
        return GST_PAD_PROBE_OK;
    self->changes_ = std::thread([self] {
        g_autoptr(GstCaps) caps =
            gst_caps_new_simple("video/x-raw", "width", G_TYPE_INT, self->width_, nullptr);
        g_object_set(self->filter_, "caps", caps, nullptr);
    });
    while (self->present_width() != self->width_)
        std::this_thread::yield();
    return GST_PAD_PROBE_REMOVE;
}

GstPadProbeReturn FickleFilter::hold_up(GstPad *, GstPadProbeInfo *info, gpointer)
{
    if (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) == GST_EVENT_RECONFIGURE)
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
    return GST_PAD_PROBE_OK;
}
