/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The selection of sparse_depth.cl for CPUs, on what focus_tiles.cl leaves: maxima are the upper halves of floats,
 * which order like integers and halve by taking HALVE away.
 */
#include "lanes32.cl"

#define RIDGE_RADIUS 3
#define HALVE 128    /* takes 1 from the exponent */
#define AHEAD 8      /* rows asked for ahead */
#define STRIP 36     /* rows a work-item */
#define SEGMENT 2048 /* columns at most: long rows are read faster */

/* Greatest of 7 neighbours in a row, for 32 pixels. */
inline ushort32 row_maximum(__global const ushort *peak)
{
    ushort32 highest = *(__global const lanes32 *)peak;
    for (int i = 1; i <= RIDGE_RADIUS; i++)
        highest = max32(highest,
                        max32(*(__global const lanes32 *)(peak - i), *(__global const lanes32 *)(peak + i)));
    return highest;
}

/* Which of 32 pixels are ridges: 255, else 0. */
inline uchar32 is_ridge(ushort32 peak, ushort32 most, ushort mean)
{
    const ushort32 ridge =
        as_ushort32(peak > (ushort)0) & as_ushort32(peak >= mean) & as_ushort32(peak + (ushort)HALVE >= most);
    return __builtin_convertvector(ridge, uchar32);
}

/* One work-item a segment of a strip; segments are equal but for the last. `peak` and `place` have `stride` pixels a row with 16 columns of 0 or more
 * between rows; sparse and moved are uchar[height][width]. */
__kernel void select_ridges(__global const ushort *peak, __global const uchar *place,
                            __global const float *tile_sums, int tiles, __global const uchar *moved,
                            __global uchar *sparse, int stride, int width, int height, int use_moved)
{
    ushort highest[(STRIP + 2 * RIDGE_RADIUS) * SEGMENT] __attribute__((aligned(64)));
    const int vectors = 32 * (int)get_num_groups(0), columns = (width + vectors - 1) / vectors * 32;
    const int left = (int)get_group_id(0) * columns, right = min(left + columns, width);
    const int top = (int)get_group_id(1) * STRIP, bottom = min(top + STRIP, height);

    float total = 0.0f;
    for (int i = 0; i < tiles; i++)
        total += tile_sums[i];
    const ushort mean = (ushort)(as_uint(total / ((float)width * height)) >> 16);

    for (int y = top - RIDGE_RADIUS; y < bottom + RIDGE_RADIUS; y++)
        for (int x = left; x < right; x += 32) {
            const int from = min(x, right - 32); /* the last lanes overlap the ones before */
            PREFETCH(peak + (ulong)(y + AHEAD) * stride + from);
            *(lanes32 *)(highest + (y - top + RIDGE_RADIUS) * SEGMENT + from - left) =
                y < 0 || y >= height ? (ushort32)0 : row_maximum(peak + (ulong)y * stride + from);
        }

    for (int y = top; y < bottom; y++)
        for (int x = left; x < right; x += 32) {
            const int from = min(x, right - 32);
            const ushort *window = highest + (y - top) * SEGMENT + from - left;
            ushort32 most = *(const lanes32 *)window;
            for (int j = 1; j <= 2 * RIDGE_RADIUS; j++)
                most = max32(most, *(const lanes32 *)(window + j * SEGMENT));
            const ulong entry = (ulong)y * stride + from, pixel = (ulong)y * width + from;
            PREFETCH(place + entry + AHEAD * stride);
            PREFETCH(moved + pixel + AHEAD * width);
            const uchar32 ridge = is_ridge(*(__global const lanes32 *)(peak + entry), most, mean);
            const uchar32 still = use_moved ? ~*(__global const bytes32 *)(moved + pixel) : (uchar32)255;
            *(__global bytes32 *)(sparse + pixel) = *(__global const bytes32 *)(place + entry) | ~(ridge & still);
        }
}
