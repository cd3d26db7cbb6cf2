/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>

namespace dff {

/* One textured plane, slanted from the near end of the sweep at the bottom to the far end at the top. */
Scene make_slant(cv::Size size, uint64_t seed);

} // namespace dff
