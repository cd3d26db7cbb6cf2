/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstddef>
#include <cstdint>

namespace dff {

/* A picture somebody else holds: 8-bit RGB, or 16-bit little endian depth. */
struct PictureView {
    const uint8_t *data;
    ptrdiff_t stride; /* bytes */
    unsigned width;
    unsigned height;

    const uint8_t *row(unsigned y) const { return data + stride * static_cast<ptrdiff_t>(y); }

    uint16_t depth(unsigned x, unsigned y) const
    {
        const uint8_t *pixel = row(y) + size_t{2} * x;
        return static_cast<uint16_t>(pixel[0] | pixel[1] << 8);
    }
};

} // namespace dff
