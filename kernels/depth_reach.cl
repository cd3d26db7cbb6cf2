/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The depth a picture is taken at where planes lie far apart. Out of focus, what is near covers what lies behind it by half
 * the blur step for each plane between them: taken at its true depth, what borders on something nearer would show a halo.
 * So a pixel is taken no farther than where that blur just reaches it:
 *
 *     D(p) <- min(D(p), min_p' (D(p') + slope |p' - p|)),  slope = 1.5 (2 / b) planes a pixel, b the blur step in pixels
 *
 * found for blocks of BLOCK x BLOCK pixels by their nearest one, octagonal distances (steps of a square and of a cross in
 * turn), and bilinear between them, `spare` of a plane farther since a block's nearest pixel is not its middle. Depth pixels
 * less 1; those without a depth (0) stay and count for no other.
 */
#include "low_picture.cl"

INLINE ushort16 least_of_pairs(ushort16 a, ushort16 b)
{
    return (ushort16)(min(a.even, a.odd), min(b.even, b.odd));
}

/* The least of each block, its sides mirrored. Work-items (1, rows of blocks); rows of 16 blocks or more. */
__kernel void nearest_of_blocks(__global const ushort *depth, int depth_stride, __global ushort *nearest, int width, int stride)
{
    const int y = (int)get_global_id(1);
    __global ushort *out = nearest + (size_t)y * stride + SIDE;
    for (int block = 0; block < width; block += 16) {
        const int x = min(block, width - 16);
        ushort16 least[BLOCK];
        UNROLL
        for (int i = 0; i < BLOCK; i++) {
            least[i] = (ushort16)65535;
            for (int j = 0; j < BLOCK; j++)
                least[i] = min(least[i], READ_USHORTS(depth + (size_t)(y * BLOCK + j) * depth_stride + x * BLOCK + 16 * i) -
                                             (ushort16)1);
        }
#if BLOCK == 4
        least[0] = least_of_pairs(least[0], least[1]);
        least[1] = least_of_pairs(least[2], least[3]);
#endif
        USHORTS(out + x) = least_of_pairs(least[0], least[1]);
    }
    mirror_short_ends((__global short *)out, width);
}

/* One block farther. The sides are mirrored, before and after. Work-items (1, rows of blocks). */
__kernel void spread_nearest(__global const ushort *nearest, __global ushort *spread, ushort slope, int is_square,
                             int width, int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    __global const ushort *above = nearest + (size_t)reflect(y - 1, height) * stride + SIDE;
    __global const ushort *here = nearest + (size_t)y * stride + SIDE;
    __global const ushort *below = nearest + (size_t)reflect(y + 1, height) * stride + SIDE;
    __global ushort *out = spread + (size_t)y * stride + SIDE;
    for (int x = 0; x < width; x += 16) {
        ushort16 least = min(min(READ_USHORTS(above + x), READ_USHORTS(below + x)),
                             min(READ_USHORTS(here + x - 1), READ_USHORTS(here + x + 1)));
        if (is_square)
            least = min(least, min(min(READ_USHORTS(above + x - 1), READ_USHORTS(above + x + 1)),
                                   min(READ_USHORTS(below + x - 1), READ_USHORTS(below + x + 1))));
        USHORTS(out + x) = min(READ_USHORTS(here + x), min(least, (ushort16)(ushort)(65535 - slope)) + (ushort16)slope);
    }
    mirror_short_ends((__global short *)out, width);
}

/* `share` 2 BLOCKths of a, the rest of b. */
INLINE ushort16 between(ushort16 a, ushort16 b, int share)
{
    return convert_ushort16((convert_uint16(a) * (uint)share + convert_uint16(b) * (uint)(2 * BLOCK - share)) / (uint)(2 * BLOCK));
}

/* limited: packed rows. Work-items (1, height). */
__kernel void limit_depth(__global const ushort *depth, int depth_stride, __global const ushort *nearest, ushort spare,
                          __global ushort *limited, int width, int blocks, int rows_of_blocks, int stride)
{
    const int y = (int)get_global_id(1), row = min(y / BLOCK, rows_of_blocks - 1), place = y % BLOCK;
    /* The row of blocks beside this one, and how much of this one counts: 2 BLOCK are all. */
    const int is_upper = 2 * place + 1 < BLOCK;
    const int share = 2 * BLOCK - (is_upper ? BLOCK - 1 - 2 * place : 2 * place + 1 - BLOCK);
    __global const ushort *here = nearest + (size_t)row * stride + SIDE;
    __global const ushort *beside = nearest + (size_t)reflect(row + (is_upper ? -1 : 1), rows_of_blocks) * stride + SIDE;
    __global const ushort *own = depth + (size_t)y * depth_stride;
    __global ushort *out = limited + (size_t)y * width;
    for (int block = 0; block < blocks; block += 16) {
        const int x = min(block, blocks - 16);
        ushort pixels[16 * BLOCK];
        ushort16 around[3];
        UNROLL
        for (int i = 0; i < 3; i++)
            around[i] = between(READ_USHORTS(here + x + i - 1), READ_USHORTS(beside + x + i - 1), share);
        UNROLL
        for (int k = 0; k < BLOCK; k++) {
            const int left = 2 * k + 1 < BLOCK;
            const ushort16 value = between(around[1], around[left ? 0 : 2],
                                           2 * BLOCK - (left ? BLOCK - 1 - 2 * k : 2 * k + 1 - BLOCK));
            for (int i = 0; i < 16; i++)
                pixels[i * BLOCK + k] = ((const ushort *)&value)[i];
        }
        for (int i = 0; i < BLOCK; i++) {
            const ushort16 pixel = READ_USHORTS(own + x * BLOCK + 16 * i);
            const ushort16 limit = min(vload16(i, pixels), (ushort16)(ushort)(65534 - spare)) + (ushort16)spare;
            USHORTS(out + x * BLOCK + 16 * i) = select(min(pixel - (ushort16)1, limit) + (ushort16)1, (ushort16)0, pixel == (ushort16)0);
        }
    }
    for (int x = blocks * BLOCK; x < width; x++)
        out[x] = own[x];
}
