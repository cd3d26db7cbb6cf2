/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>

namespace dff {

/* Which plane a picture truly shows, written into its pixels: tests hold it against the label. 64 pixels, bit
 * 63 first, black or white: 8 bits of `stamp_mark`, 8 of the plane, 32 of the sweep, 16 of the sum of the six
 * bytes before. */
constexpr unsigned stamp_pixels = 64;
constexpr uint8_t stamp_mark = 0xd5;

uint64_t frame_stamp(uint32_t sweep, uint8_t plane);

} // namespace dff
