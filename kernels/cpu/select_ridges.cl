/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The selection of sparse_depth.cl for CPUs, on what focus_tiles.cl leaves: maxima are the upper halves of floats,
 * which order like integers and halve by taking HALVE away.
 */
#define RIDGE_RADIUS 3
#define HALVE 128
#define STRIP 36 /* rows a work-item */
#define SEGMENT 256 /* columns a work-item; the last one has the rest too, so that none has less than 16 */

/* Greatest of 7 neighbours in a row, for 16 pixels. */
inline ushort16 row_maximum(__global const ushort *peak)
{
    ushort16 highest = *(__global const lanes16 *)peak;
    for (int i = 1; i <= RIDGE_RADIUS; i++)
        highest = max(highest, max(*(__global const lanes16 *)(peak - i), *(__global const lanes16 *)(peak + i)));
    return highest;
}

/* One work-item a segment of a strip. `peak` and `peak_plane` have `stride` pixels a row with 16 columns of 0 or more
 * between rows; sparse and moved are uchar[height][width]. */
__kernel void select_ridges(__global const ushort *peak, __global const uchar *peak_plane,
                            __global const float *tile_sums, int tiles, __global const uchar *moved,
                            __global uchar *sparse, int stride, int width, int height, int use_moved)
{
    ushort highest[(STRIP + 2 * RIDGE_RADIUS) * 2 * SEGMENT];
    const int left = (int)get_group_id(0) * SEGMENT;
    const int right = get_group_id(0) + 1 == get_num_groups(0) ? width : left + SEGMENT;
    const int top = (int)get_group_id(1) * STRIP, bottom = min(top + STRIP, height);

    float total = 0.0f;
    for (int i = 0; i < tiles; i++)
        total += tile_sums[i];
    const ushort mean = (ushort)(as_uint(total / ((float)width * height)) >> 16);

    for (int y = top - RIDGE_RADIUS; y < bottom + RIDGE_RADIUS; y++)
        for (int x = left; x < right; x += 16)
            *(lanes16 *)(highest + (y - top + RIDGE_RADIUS) * 2 * SEGMENT + x - left) =
                y < 0 || y >= height ? (ushort16)0 : row_maximum(peak + (ulong)y * stride + x);

    for (int y = top; y < bottom; y++)
        for (int x = left; x < right; x += 16) {
            const int from = min(x, right - 16); /* the last lanes overlap the ones before */
            const ushort16 p = *(__global const lanes16 *)(peak + (ulong)y * stride + from);
            const uchar16 plane = *(__global const lanes8 *)(peak_plane + (ulong)y * stride + from);
            const ushort *window = highest + (y - top) * 2 * SEGMENT + from - left;
            ushort16 most = *(const lanes16 *)window;
            for (int j = 1; j <= 2 * RIDGE_RADIUS; j++)
                most = max(most, *(const lanes16 *)(window + j * 2 * SEGMENT));
            const char16 ridge = convert_char16(p > (ushort)0 && p >= mean && p + (ushort)HALVE >= most);
            const ulong pixel = (ulong)y * width + from;
            const uchar16 still = use_moved ? ~*(__global const lanes8 *)(moved + pixel) : (uchar16)255;
            *(__global lanes8 *)(sparse + pixel) = plane | ~(as_uchar16(ridge) & still);
        }
}
