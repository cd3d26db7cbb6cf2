/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/video/video.h>

#include <string>

namespace dff {

/* Time from frame to frame, 0 where the caps do not say. */
GstClockTime frame_period(const GstVideoInfo &info);

/* Why a buffer of `size` bytes is no picture of these caps: for a user who set sizes by hand. */
std::string describe_misfit(const GstVideoInfo &info, gsize size);

} // namespace dff
