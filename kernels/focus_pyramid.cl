/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Focus on coarser scales, each half the one before, for what changes too little from plane to plane on finer ones:
 *
 *     E = box_1(SML(g * L)),  SML(L) = |[-1 2 -1] * L|_x + |.|_y
 *
 * L is the mean of R, G, B of the small planes, area-downsampled on; g, in noise, the binomial nearest to a Gaussian of
 * .8t cells. L is in 1/COLOUR_ONE DN, E in 1/FOCUS_ONE DN; the sides of both are mirrored.
 */
#include "low_picture.cl"

#define IS_WANTED(z) (wanted >> (z) & 1 || noise->is_new)

/* L of the first scale. Work-items (1, low height, planes). */
__kernel void mean_colours(__global const short *small, ulong wanted, __global const Noise *noise,
                           __global short *luma, int width, int stride)
{
    const int y = (int)get_global_id(1), z = (int)get_global_id(2), height = (int)get_global_size(1);
    if (!IS_WANTED(z))
        return;
    const size_t picture = (size_t)height * stride;
    __global const short *colours = small + 3 * z * picture + (size_t)y * stride + SIDE;
    __global short *out = luma + z * picture + (size_t)y * stride + SIDE;
    for (int x = 0; x < width; x += 16) {
        /* Colours from YUV lie within -255 and 510 DN: a third of each first. */
        const int16 sum = convert_int16(READ_SHORTS(colours + x)) + convert_int16(READ_SHORTS(colours + picture + x)) +
                          convert_int16(READ_SHORTS(colours + 2 * picture + x));
        SHORTS(out + x) = convert_short16((sum * 21845 + 32768) >> 16);
    }
    mirror_short_ends(out, width);
}

/* L of the next scale: means of 2x2. Work-items (1, its height, planes). */
__kernel void halve_luma(__global const short *finer, int finer_height, int finer_stride, ulong wanted,
                         __global const Noise *noise, __global short *luma, int width, int stride)
{
    const int y = (int)get_global_id(1), z = (int)get_global_id(2), height = (int)get_global_size(1);
    if (!IS_WANTED(z))
        return;
    __global const short *upper = finer + ((size_t)z * finer_height + 2 * y) * finer_stride + SIDE;
    __global const short *lower = upper + finer_stride;
    __global short *out = luma + ((size_t)z * height + y) * stride + SIDE;
    for (int x = 0; x < width; x += 8) {
        const short16 sum = (READ_SHORTS(upper + 2 * x) >> (short)1) + (READ_SHORTS(lower + 2 * x) >> (short)1);
        HALF_SHORTS(out + x) = (sum.even + sum.odd + (short)1) >> (short)1;
    }
    mirror_short_ends(out, width);
}

/* A row of g * L with its sides mirrored: over columns, then over rows. `side`: the outer taps in 1/65536. */
INLINE void soften_row(__global const short *luma, int y, int height, uint side, __global short *half_soft,
                       __global short *soft, int width, int stride)
{
    __global const short *above = luma + (size_t)reflect(y - 1, height) * stride;
    __global const short *here = luma + (size_t)y * stride;
    __global const short *below = luma + (size_t)reflect(y + 1, height) * stride;
#define SOFTEN(before, centre, after)                                                                                  \
    ((centre) + convert_short16((convert_int16((before) + (after) - (centre) - (centre)) * (int)side) >> 16))
    for (int x = 0; x < width; x += 16)
        SHORTS(half_soft + x) = SOFTEN(READ_SHORTS(above + x), READ_SHORTS(here + x), READ_SHORTS(below + x));
    mirror_short_ends(half_soft, width);
    for (int x = 0; x < width; x += 16)
        SHORTS(soft + x) = SOFTEN(READ_SHORTS(half_soft + x - 1), READ_SHORTS(half_soft + x), READ_SHORTS(half_soft + x + 1));
    mirror_short_ends(soft, width);
}

INLINE ushort16 curvature(short16 here, short16 before, short16 after)
{
    const short16 v = here + here - before - after;
    return as_ushort16(max(v, -v));
}

#define SOFT_RING 4
#define SUM_RING 4
#define SCRATCH_ROWS (SOFT_RING + SUM_RING + 2)

/* E. One work-item takes `strip` rows of one plane: work-items (1, strips, planes); scratch: SCRATCH_ROWS for each. */
__kernel void measure_focus(__global const short *luma, ulong wanted, __global const Noise *noise,
                            __global short *focus, __global short *scratch, int width, int height, int stride, int strip)
{
    const int z = (int)get_global_id(2), first = (int)get_global_id(1) * strip, last = min(first + strip, height);
    if (!IS_WANTED(z))
        return;
    const size_t picture = (size_t)height * stride;
    __global short *soft = scratch +
                           (get_global_id(2) * get_global_size(1) + get_global_id(1)) * SCRATCH_ROWS * (size_t)stride + SIDE;
    __global short *sums = soft + SOFT_RING * (size_t)stride, *spare = sums + SUM_RING * (size_t)stride;
    const float t = noise->t > QUIET ? noise->t : 0.0f;
    const uint side = (uint)(65536.0f * 0.32f * t * t); /* variance (.8t)^2 is twice a tap */
    luma += z * picture + SIDE;
    focus += z * picture + SIDE;

    int soft_ready = first - 2;
    for (int row = first - 1; row <= last; row++) {
        for (; soft_ready <= row + 1; soft_ready++)
            soften_row(luma, reflect(soft_ready, height), height, side, spare,
                       soft + (size_t)((soft_ready + 8) % SOFT_RING) * stride, width, stride);
#define SOFT_ROW(y) (soft + (size_t)(((y) + 8) % SOFT_RING) * stride)
        __global const short *above = SOFT_ROW(row - 1), *here = SOFT_ROW(row), *below = SOFT_ROW(row + 1);
        __global short *out = sums + (size_t)((row + 8) % SUM_RING) * stride;
        for (int x = 0; x < width; x += 16) {
            const short16 centre = READ_SHORTS(here + x);
            SHORTS(out + x) = as_short16(curvature(centre, READ_SHORTS(here + x - 1), READ_SHORTS(here + x + 1)) +
                                         curvature(centre, READ_SHORTS(above + x), READ_SHORTS(below + x)));
        }
        if (row < first + 1)
            continue;
#define SUM_ROW(y) ((__global const ushort *)sums + (size_t)(((y) + 8) % SUM_RING) * stride + x)
        for (int x = 0; x < width; x += 16)
            SHORTS(spare + x) =
                as_short16(READ_USHORTS(SUM_ROW(row - 2)) + READ_USHORTS(SUM_ROW(row - 1)) + READ_USHORTS(SUM_ROW(row)));
        mirror_short_ends(spare, width);
        __global const ushort *columns = (__global const ushort *)spare;
        __global short *focused = focus + (size_t)(row - 1) * stride;
        for (int x = 0; x < width; x += 16) {
            const uint16 sum = convert_uint16(READ_USHORTS(columns + x - 1)) + convert_uint16(READ_USHORTS(columns + x)) +
                               convert_uint16(READ_USHORTS(columns + x + 1));
            SHORTS(focused + x) =
                convert_short16(min((sum * (uint)(65536 * FOCUS_ONE / COLOUR_ONE / 9)) >> 16u, (uint16)32767));
        }
        mirror_short_ends(focused, width);
    }
}
