/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "optics/depth_scale.h"

#include <gst/dff/dff.h>

namespace dff {

/* What the pixels of a depth frame mean: what its meta says; without one, what its caps say by the
 * conventions of each unit; without both, plane positions of unknown number. Throws std::invalid_argument
 * with a user's text if the caps say too little. */
GstDepthInfo depth_of(GstBuffer *frame, const GstCaps *caps);

DepthScale scale_of(const GstDepthInfo &depth);

} // namespace dff
