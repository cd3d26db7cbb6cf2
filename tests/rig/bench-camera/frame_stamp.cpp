/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "frame_stamp.h"

namespace dff {

uint64_t frame_stamp(uint32_t sweep, uint8_t plane)
{
    const uint64_t bytes = uint64_t{stamp_mark} << 40 | uint64_t{plane} << 32 | sweep;
    uint64_t sum = 0;
    for (unsigned shift = 0; shift < 48; shift += 8)
        sum += bytes >> shift & 0xff;
    return bytes << 16 | sum;
}

} // namespace dff
