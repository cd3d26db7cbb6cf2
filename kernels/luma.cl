/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Luma of interleaved colours, BT.601: Y = 0.299 R + 0.587 G + 0.114 B, rounded to as many bits as they have.
 */
#if LUMA_BYTES == 2
#define LUMA ushort
#else
#define LUMA uchar
#endif

/* stack -> luma[planes][height][width]. channels = (samples a pixel, index of R, G, B). */
__kernel void luma_of_colours(__global const uchar *stack, __global const ulong2 *rows, __global LUMA *luma, int width,
                              int height, int4 channels)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
    if (x >= width)
        return;
    __global const uchar *row = stack + rows[z].x + rows[z].y * (ulong)y;
    const ulong pixel = (ulong)x * channels.s0;
    const uint weighted = 19595u * sample_of(row, pixel + channels.s1) + 38470u * sample_of(row, pixel + channels.s2) +
                          7471u * sample_of(row, pixel + channels.s3);
    luma[((ulong)z * height + y) * width + x] = (LUMA)((weighted + 32768u) >> 16);
}
