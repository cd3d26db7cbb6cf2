/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/dff.h>
#include <string>
#include <utility>
#include <vector>

namespace dff {

/* What the pixels of a depth stream mean, as attributes (a= lines) of its SDP: depth-unit, depth-scale and
 * depth-offset (value = offset + scale * pixel), and where they are known depth-near and depth-far (dioptres)
 * and depth-intrinsics (fx fy cx cy k1 k2 p1 p2 k3, pixels and OpenCV's distortion). */
std::vector<std::pair<std::string, std::string>> depth_attributes(const GstDepthInfo &info);

} // namespace dff
