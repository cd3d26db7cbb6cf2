/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "captured_frame.h"
#include "gst_pointer.h"

#include <gst/app/app.h>

namespace dff {

/* Hands captured frames to the appsrc of a mount. Used by one thread at a time. */
class Outlet {
public:
    /* Sets the appsrc up: live, in time, and dropping its oldest frames when the mount is too slow. */
    explicit Outlet(GstElement *appsrc);

    /* Frames taken before the mount began to play are left out. Never blocks. */
    void push(const CapturedFrame &frame);

private:
    ObjectPointer<GstElement> appsrc_;
    GstClockTime latency_ = GST_CLOCK_TIME_NONE;
};

} // namespace dff
