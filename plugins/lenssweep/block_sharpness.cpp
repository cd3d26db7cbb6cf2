/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "block_sharpness.h"

namespace {

constexpr unsigned grid = 16;
constexpr unsigned distance = 2;
constexpr unsigned least_side = grid * 3;

/* Of the samples from column `begin` up to `end` in a row. */
uint64_t squares(const uint8_t *row, size_t pixel_stride, unsigned begin, unsigned end)
{
    uint64_t sum = 0;
    for (unsigned x = begin; x + distance < end; x++) {
        const int difference = row[(x + distance) * pixel_stride] - row[x * pixel_stride];
        sum += static_cast<uint64_t>(difference * difference);
    }
    return sum;
}

} // namespace

std::vector<double> block_sharpness(const PictureView &picture)
{
    if (picture.width < least_side || picture.height < least_side)
        return {};
    const unsigned block_width = picture.width / grid;
    const unsigned block_height = picture.height / grid;
    std::vector<double> sharpness(static_cast<size_t>(grid) * grid);
    for (unsigned y = 0; y < block_height * grid; y++) {
        const uint8_t *row = picture.pixels + y * picture.stride;
        for (unsigned block = 0; block < grid; block++)
            sharpness[y / block_height * grid + block] += static_cast<double>(
                squares(row, picture.pixel_stride, block * block_width, (block + 1) * block_width));
    }
    for (double &value : sharpness)
        value /= static_cast<double>(block_width - distance) * block_height;
    return sharpness;
}
