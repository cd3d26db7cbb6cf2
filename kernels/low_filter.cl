/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Separable symmetric filters of low pictures, one after the other in a volume. taps[0..radius] from the centre
 * outward. Work-items (1, height, pictures).
 */
#include "low_picture.cl"

/* Where `noise` is given, only in noise. */
inline int is_idle(__global const Noise *noise)
{
    return noise && noise->t <= QUIET;
}

/* Mirrors the 8 cells at both ends of each row into its sides. */
__kernel void mirror_sides(__global float *volume, __global const Noise *noise, int width, int stride)
{
    if (is_idle(noise))
        return;
    __global float *row =
        volume + (get_global_id(2) * get_global_size(1) + get_global_id(1)) * (size_t)stride + SIDE;
    CELLS(row - 8) = READ_CELLS(row).s76543210;
    CELLS(row + width) = READ_CELLS(row + width - 8).s76543210;
}

__kernel void filter_columns(__global const float *volume, __global float *filtered, __constant float *taps,
                             int radius, __global const Noise *noise, int width, int stride)
{
    if (is_idle(noise))
        return;
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t picture = get_global_id(2) * height * (size_t)stride + SIDE;
    for (int x = 0; x < width; x += 8) {
        float8 sum = taps[0] * READ_CELLS(volume + picture + (size_t)y * stride + x);
        for (int i = 1; i <= radius; i++)
            sum += taps[i] * (READ_CELLS(volume + picture + (size_t)reflect(y - i, height) * stride + x) +
                              READ_CELLS(volume + picture + (size_t)reflect(y + i, height) * stride + x));
        CELLS(filtered + picture + (size_t)y * stride + x) = sum;
    }
}

/* The sides of `volume` must be mirrored. */
__kernel void filter_rows(__global const float *volume, __global float *filtered, __constant float *taps, int radius,
                          __global const Noise *noise, int width, int stride)
{
    if (is_idle(noise))
        return;
    const size_t row = (get_global_id(2) * get_global_size(1) + get_global_id(1)) * (size_t)stride + SIDE;
    for (int x = 0; x < width; x += 8) {
        float8 sum = taps[0] * READ_CELLS(volume + row + x);
        for (int i = 1; i <= radius; i++)
            sum += taps[i] * (READ_CELLS(volume + row + x - i) + READ_CELLS(volume + row + x + i));
        CELLS(filtered + row + x) = sum;
    }
}
