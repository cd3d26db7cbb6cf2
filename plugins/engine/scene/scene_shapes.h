/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <stop_token>

namespace dff {

/* Balls, blocks and pillars, textured and plain, on a textured ground that slants from the near end of the
 * sweep away to a textured wall near its far end. `seed` changes the textures, not the arrangement. Runs on
 * all cores; unfinished where `stop` was requested. */
Scene make_shapes(cv::Size size, uint64_t seed, const std::stop_token &stop = {});

} // namespace dff
