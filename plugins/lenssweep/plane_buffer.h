/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "camera_caps.h"

#include "camera/sweep_capture.h"

#include <gst/gst.h>

/* How a captured plane goes out. */
struct PlaneOutput {
    CameraFormat format;
    guint planes = 0;
    gdouble power = 0; /* dioptres, NAN if unknown */
    gint code = -1;
    GstClockTime exposure = 0;
    GstClockTime duration = 0;
    GstCaps *clock_caps = nullptr; /* of the camera's clock; borrowed */
};

/* A buffer with the plane's pixels, in the camera's memory where its rows are as GStreamer has them, its
 * GstFocusMeta and the camera's time. No PTS. Null if the camera sent fewer bytes than a picture has. */
GstBuffer *plane_buffer(dff::CapturedPlane plane, const PlaneOutput &output);

/* A structure for the property `stats`; `delivered` counts buffers. */
GstStructure *capture_stats(const dff::CaptureCounts &counts, guint64 delivered);

/* Frames that should have been planes and are not. */
guint64 missing_planes(const dff::CaptureCounts &counts);
