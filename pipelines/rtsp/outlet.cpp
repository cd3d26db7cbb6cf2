/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "outlet.h"

#include "log.h"

namespace dff {

namespace {

/* Enough for one sweep of planes; pictures in wait are memory. */
constexpr guint64 most_waiting = 8;

} // namespace

Outlet::Outlet(GstElement *appsrc) : appsrc_(share(appsrc))
{
    g_object_set(appsrc, "is-live", TRUE, "format", GST_FORMAT_TIME, "max-buffers", most_waiting, "max-bytes",
                 guint64{0}, "leaky-type", GST_APP_LEAKY_TYPE_DOWNSTREAM, nullptr);
}

void Outlet::push(const CapturedFrame &frame)
{
    GstAppSrc *appsrc = GST_APP_SRC(appsrc_.get());
    const GstClockTime base = gst_element_get_base_time(appsrc_.get());
    if (GST_STATE(appsrc) != GST_STATE_PLAYING || frame.time < base) {
        GST_DEBUG_OBJECT(appsrc, "Left out, as it does not play yet: %" GST_PTR_FORMAT, frame.buffer);
        return;
    }
    GST_LOG_OBJECT(appsrc, "%" GST_PTR_FORMAT, frame.buffer);
    if (frame.latency != latency_) {
        latency_ = frame.latency;
        GST_INFO_OBJECT(appsrc, "The latency is %" GST_TIME_FORMAT, GST_TIME_ARGS(latency_));
        gst_app_src_set_latency(appsrc, latency_, GST_CLOCK_TIME_NONE);
    }
    GstBuffer *buffer = gst_buffer_copy(frame.buffer); /* the pixels are shared */
    GST_BUFFER_PTS(buffer) = frame.time - base;
    GST_BUFFER_DTS(buffer) = GST_CLOCK_TIME_NONE;
    gst_app_src_set_caps(appsrc, frame.caps);
    gst_app_src_push_buffer(appsrc, buffer);
}

} // namespace dff
