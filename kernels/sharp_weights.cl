/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * How much of each plane the all-in-focus picture of sharp_blend.cl takes, in every band of detail. At level l >= 1
 *
 *     w_z = max(1 - |z - u| / REACH, 0) * ((D_z + FLOOR) / max (D + FLOOR))^32,
 *     D_l = max(binomial_5x5(max_5x5(F_l)), up(D_l+1) / 2)
 *
 * F at level 1 is of 2 x 2 gradients of luma three parts their mean and one the greatest, since of a line that lies
 * between two cells either has but half; at the levels above it is the greatest of 2 x 2. The sharpest edge around
 * decides, and the farther around the coarser the band: the skirt of a blurred edge is as wide as the bands that it
 * shows in, and would win beside the edge itself. Twice as far away an edge counts half, as the skirt that it may have
 * in another plane has half the slope: where that is wider than the squares, bands of different planes would add up
 * to a dark rim. In the finest band, that of single pixels, it hardly shows; its weights lie in cells of level 1 too,
 * with max_3x3 instead of max_5x5, nothing of the level above and the 64th power, since neighbouring planes differ by
 * little.
 *
 * u is the plane position of the depth, the nearest of the pixels that have one; without any, every plane has the first
 * factor 1. Where nothing is sharp all D are alike and the planes are averaged.
 *
 * The gradient is max(a, b) + 3/8 min(a, b) of the two directions' Sobel sums a and b, in 1/SHARPNESS_ONE DN; weights
 * are 255 w / sum w. Work-items are (16 cells, row, plane) of a level.
 */
#include "pyramid_rows.cl"

#define REACH 2.5f
#define SHARPNESS_ONE 128
#define FLOOR (0.1f * SHARPNESS_ONE)

/* Luma in 1/16 DN, which leaves sums of 4 their sign in 16 bits. */
#if LUMA_BYTES == 2
#define LUMA ushort
#define LUMA_16THS(v) as_short16((v) >> (ushort16)4)
#else
#define LUMA uchar
#define LUMA_16THS(v) convert_short16(v) << (short16)4
#endif

/* Of a row, at 16 pixels from x on: the difference of the neighbours, and the sum 1 2 1. */
typedef struct {
    short16 difference, sum;
} Along;

INLINE Along along(__global const LUMA *row, int x, int width)
{
    const short16 left = LUMA_16THS(load_clamped(row, x - 1, width));
    const short16 here = LUMA_16THS(load_clamped(row, x, width));
    const short16 right = LUMA_16THS(load_clamped(row, x + 1, width));
    const Along found = {right - left, left + here + here + right};
    return found;
}

INLINE ushort16 magnitude(Along above, Along here, Along below)
{
    const short16 dx = above.difference + here.difference + here.difference + below.difference;
    const short16 dy = below.sum - above.sum;
    const ushort16 a = as_ushort16(max(dx, -dx)), b = as_ushort16(max(dy, -dy));
    const ushort16 least = min(a, b);
    return max(a, b) + (least >> (ushort16)2) + (least >> (ushort16)3);
}

/* (a + b) / 2, rounded down; the sum has 16 bits. */
INLINE ushort16 half_of(ushort16 a, ushort16 b)
{
    return (a + b) >> (ushort16)1;
}

/* Of the gradient's magnitude in two rows at 16 pixels. */
typedef struct {
    ushort16 mean, greatest;
} Gradients;

INLINE Gradients gradients(__global const LUMA *const *rows, int x, int width)
{
    Along lines[4];
    for (int i = 0; i < 4; i++)
        lines[i] = along(rows[i], x, width);
    const ushort16 upper = magnitude(lines[0], lines[1], lines[2]), lower = magnitude(lines[1], lines[2], lines[3]);
    const Gradients found = {half_of(upper, lower), max(upper, lower)};
    return found;
}

/* F of level 1. */
__kernel void sharpness(__global const uchar *stack, __global const ulong2 *table, int2 size, __global ushort *volume,
                        Level level)
{
    const int x = (int)get_global_id(0) * 16, y = (int)get_global_id(1), z = (int)get_global_id(2);
    if (x >= level.width)
        return;
    __global const LUMA *rows[4];
    for (int i = 0; i < 4; i++)
        rows[i] = (__global const LUMA *)(stack + table[z].x + table[z].y * (ulong)clamp(2 * y - 1 + i, 0, size.y - 1));
    const Gradients left = gradients(rows, 2 * x, size.x), right = gradients(rows, 2 * x + 16, size.x);
    const ushort16 mean =
        half_of((ushort16)(left.mean.even, right.mean.even), (ushort16)(left.mean.odd, right.mean.odd));
    const ushort16 greatest = max((ushort16)(left.greatest.even, right.greatest.even),
                                  (ushort16)(left.greatest.odd, right.greatest.odd));
    store_cells(volume + row_of(level, z, y), x, level.width, mean + ((greatest - mean) >> (ushort16)2));
}

/* The 32 cells of level l that 16 of level l + 1 lie over, in two rows: what `better` leaves of each four. */
#define OF_FOUR(better)                                                                                                \
    const int x = (int)get_global_id(0) * 16, y = (int)get_global_id(1), z = (int)get_global_id(2);                    \
    if (x >= coarse.width)                                                                                             \
        return;                                                                                                        \
    __global const ushort *above = volume + row_of(level, z, 2 * y) + 2 * x;                                           \
    __global const ushort *below = volume + row_of(level, z, 2 * y + 1) + 2 * x;                                       \
    const ushort16 left = better(*(__global const lanes16 *)above, *(__global const lanes16 *)below);                  \
    const ushort16 right = better(*(__global const lanes16 *)(above + 16), *(__global const lanes16 *)(below + 16));   \
    store_cells(result + row_of(coarse, z, y), x, coarse.width,                                                        \
                better((ushort16)(left.even, right.even), (ushort16)(left.odd, right.odd)))

__kernel void greatest_of_four(__global const ushort *volume, Level level, __global ushort *result, Level coarse)
{
    OF_FOUR(max);
}

__kernel void least_of_four(__global const ushort *volume, Level level, __global ushort *result, Level coarse)
{
    OF_FOUR(min);
}

/* Five cells in a row (step (1, 0)) or a column (step (0, 1)). */
#define FIVE_CELLS                                                                                                     \
    const int x = (int)get_global_id(0) * 16, y = (int)get_global_id(1), z = (int)get_global_id(2);                    \
    if (x >= level.width)                                                                                              \
        return;                                                                                                        \
    ushort16 cells[5];                                                                                                 \
    for (int i = 0; i < 5; i++)                                                                                        \
        cells[i] = *(__global const lanes16 *)(volume + row_of(level, z, y + (i - 2) * step.y) + x + (i - 2) * step.x)

__kernel void greatest_of_five(__global const ushort *volume, __global ushort *result, Level level, int2 step)
{
    FIVE_CELLS;
    store_cells(result + row_of(level, z, y), x, level.width,
                max(max(max(cells[0], cells[1]), max(cells[2], cells[3])), cells[4]));
}

__kernel void greatest_of_three(__global const ushort *volume, __global ushort *result, Level level, int2 step)
{
    FIVE_CELLS;
    store_cells(result + row_of(level, z, y), x, level.width, max(max(cells[1], cells[2]), cells[3]));
}

/* Weights 1 4 6 4 1; F has at most 22440. */
INLINE ushort16 softened(const ushort16 *cells)
{
    const ushort16 outer = half_of(cells[0], cells[4]), inner = half_of(cells[1], cells[3]);
    const ushort16 rest = half_of(outer, cells[2]); /* 1 of 4, 1 and 2; inner is 2 of 4 */
    return half_of(half_of(rest, cells[2]), inner);
}

__kernel void soften(__global const ushort *volume, __global ushort *result, Level level, int2 step)
{
    FIVE_CELLS;
    store_cells(result + row_of(level, z, y), x, level.width, softened(cells));
}

/* And at least half of what the level above has there. */
__kernel void soften_upon(__global const ushort *volume, __global ushort *result, Level level, int2 step,
                          __global const ushort *above, Level coarse)
{
    FIVE_CELLS;
    const ushort16 least = convert_ushort16(0.5f * upsampled(above, coarse_rows(coarse, z, x, y)));
    store_cells(result + row_of(level, z, y), x, level.width, max(softened(cells), least));
}

/* The nearest depth of 2 x 2 pixels, less 1: none is 65535. */
__kernel void nearest_of_pixels(__global const ushort *depth, int depth_stride, int2 size, __global ushort *nearest,
                                Level level)
{
    const int x = (int)get_global_id(0) * 16, y = (int)get_global_id(1);
    if (x >= level.width)
        return;
    __global const ushort *above = depth + (ulong)(2 * y) * depth_stride;
    __global const ushort *below = depth + (ulong)min(2 * y + 1, size.y - 1) * depth_stride;
    const ushort16 one = 1;
    const ushort16 left = min(load_clamped(above, 2 * x, size.x) - one, load_clamped(below, 2 * x, size.x) - one);
    const ushort16 right =
        min(load_clamped(above, 2 * x + 16, size.x) - one, load_clamped(below, 2 * x + 16, size.x) - one);
    store_cells(nearest + row_of(level, 0, y), x, level.width,
                min((ushort16)(left.even, right.even), (ushort16)(left.odd, right.odd)));
}

/* Plane positions, and the planes from which to which one of them takes something. */
typedef struct {
    float16 u;
    int first, last;
} Positions;

INLINE Positions positions_of(__global const ushort *nearest, __global const float *table, int planes)
{
    float u[16], least = planes - 1, most = 0.0f;
    for (int i = 0; i < 16; i++) {
        u[i] = table[(nearest[i] + 1) & 65535];
        least = u[i] < 0.0f ? 0.0f : min(least, u[i]);
        most = u[i] < 0.0f ? planes - 1 : max(most, u[i]);
    }
    const Positions found = {vload16(0, u), max((int)(least - REACH), 0), min((int)(most + REACH), planes - 1)};
    return found;
}

INLINE float16 nearness(float16 u, int z)
{
    return select(max(1.0f - fabs(u - (float)z) / REACH, (float16)0.0f), (float16)1.0f, u < 0.0f);
}

INLINE float16 weight(float16 near, float16 sharpness, float16 sharpest, int squarings)
{
    float16 share = min(sharpness / sharpest, (float16)1.0f); /* planes without nearness may be sharper */
    for (int i = 0; i < squarings; i++)
        share *= share;
    return near * share;
}

/* The power is 2^squarings. Work-items (16 cells, row). */
__kernel void weigh(__global const ushort *volume, __global const ushort *nearest, __global const float *positions,
                    __global uchar *weights, Level level, int planes, int squarings)
{
    const int x = (int)get_global_id(0) * 16, y = (int)get_global_id(1);
    if (x >= level.width)
        return;
    const Positions at = positions_of(nearest + row_of(level, 0, y) + x, positions, planes);
    const ulong picture = (ulong)level.height * level.stride, cells = row_of(level, 0, y);
#define SHARPNESS(z) (convert_float16(*(__global const lanes16 *)(volume + (z) * picture + cells + x)) + FLOOR)

    float16 sharpest = FLOOR, sum = 0.0f;
    for (int z = at.first; z <= at.last; z++)
        sharpest = max(sharpest, select((float16)0.0f, SHARPNESS(z), nearness(at.u, z) > 0.0f));
    for (int z = at.first; z <= at.last; z++)
        sum += weight(nearness(at.u, z), SHARPNESS(z), sharpest, squarings);
    for (int z = 0; z < planes; z++) {
        uchar16 share = 0;
        if (z >= at.first && z <= at.last)
            share = convert_uchar16(weight(nearness(at.u, z), SHARPNESS(z), sharpest, squarings) * (255.0f / sum) + 0.5f);
        store_cells(weights + z * picture + cells, x, level.width, share);
    }
}
