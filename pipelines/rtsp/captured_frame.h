/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

namespace dff {

/* A frame on its way from the source to the mounts. Owned by the caller. */
struct CapturedFrame {
    GstBuffer *buffer;
    GstCaps *caps;
    GstClockTime time;    /* of its first exposure, by the system clock */
    GstClockTime latency; /* from `time` until the source gives the frame out, at most */
};

} // namespace dff
