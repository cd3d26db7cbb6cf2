/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/* The samples of one component of a picture, 8 bits each. */
struct PictureView {
    const uint8_t *pixels = nullptr;
    unsigned width = 0;
    unsigned height = 0;
    size_t stride = 0;       /* bytes from row to row */
    size_t pixel_stride = 0; /* bytes from sample to sample */
};

/* How sharp a picture is in each block of a grid of 16x16, row by row: the mean square of the difference of
 * samples two apart, which are of one colour in a Bayer mosaic. Empty for pictures that are too small. */
std::vector<double> block_sharpness(const PictureView &picture);
