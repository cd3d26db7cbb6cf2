/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/base/gstaggregator.h>
#include <optional>

namespace dff {

/* The depth map that goes with `color`, taken from its pad, or nullptr if it has none; empty if it has not
 * come yet. They go together by running time, within half a picture's duration; where either has no time, the
 * first goes with the first. Maps of pictures that never came are dropped. */
std::optional<GstBuffer *> matching_depth(GstAggregatorPad *color_pad, GstBuffer *color,
                                          GstAggregatorPad *depth_pad);

} // namespace dff
