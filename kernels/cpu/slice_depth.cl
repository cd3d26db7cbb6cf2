/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * For CPUs, tile by tile: the slice of bilateral_grid.cl, the Gaussian of gaussian_blur.cl and the coding of
 * depth_code.cl. RADIUS taps on each side of the Gaussian's centre, and what luma_grid.cl says of the grid, are built
 * in.
 */
#include "lanes32.cl"

#define TILE_WIDTH 256 /* multiple of 16 */
#define TILE_HEIGHT 64
#define AHEAD 4    /* rows of luma asked for ahead */
#define TOGETHER 8 /* rows blurred at once, a divisor of TILE_HEIGHT */
#if RADIUS <= 24
#define UNROLL_SMALL __attribute__((opencl_unroll_hint))
#else
#define UNROLL_SMALL
#endif
#define ORIGIN ((RADIUS + 15) / 16 * 16) /* where a row of the tile begins in a row of scratch: whole lanes */
#define STRIDE (ORIGIN + TILE_WIDTH + ORIGIN + 16)

inline float16 symmetric_tap(const float *centre, int distance)
{
    return *(const flanes *)(centre - distance) + *(const flanes *)(centre + distance);
}

/* The Gaussian along y for 16 columns of TOGETHER rows, the first of which stands RADIUS rows below `u`: each row of u
 * is read once. */
inline void blur_columns(const float *u, __constant float *taps, float *blurred)
{
    float16 sums[TOGETHER];
    __attribute__((opencl_unroll_hint))
    for (int k = 0; k < TOGETHER; k++)
        sums[k] = 0.0f;
    UNROLL_SMALL
    for (int i = 0; i <= 2 * RADIUS + TOGETHER - 1; i++) {
        const float16 here = *(const float16 *)(u + i * STRIDE);
        __attribute__((opencl_unroll_hint))
        for (int k = 0; k < TOGETHER; k++)
            if (i >= k && i <= k + 2 * RADIUS)
                sums[k] += taps[abs(i - k - RADIUS)] * here;
    }
    __attribute__((opencl_unroll_hint))
    for (int k = 0; k < TOGETHER; k++)
        *(float16 *)(blurred + k * STRIDE) = sums[k];
}

/* Values of a table of 16 at `index`: the compiler's pattern for one permutation where the processor has it. */
inline float16 look_up(float16 table, int16 index)
{
    float16 found;
    __attribute__((opencl_unroll_hint))
    for (int i = 0; i < 16; i++)
        found[i] = table[index[i]];
    return found;
}

/* Positions of 16 pixels in one column of the grid, a cell for each step of luma. */
inline float16 slice_16(__global const float *column, uchar16 luma)
{
    const int16 step = convert_int16(luma) / SIGMA_LUMA;
#if COLUMN <= 17
    return look_up(*(__global const flanes *)column, step);
#else
    float lanes[16];
    for (int i = 0; i < 16; i++)
        lanes[i] = column[step[i]];
    return *(const flanes *)lanes;
#endif
}

/* Slices the columns from..to of a row. */
inline void slice_row(__global const float *cells, __global const uchar *luma, int width, int from, int to, float *u)
{
    for (int x = from; x < to;) {
        __global const float *column = cells + x / SIGMA_XY * COLUMN;
        const int column_end = min((x / SIGMA_XY + 1) * SIGMA_XY, to);
        for (; x < column_end; x += 16) { /* the last lanes may be other columns', which write theirs later */
            const int first = min(x, width - 16); /* at the right border the lanes before x come along */
            PREFETCH(luma + AHEAD * width + x);
            const float16 position = slice_16(column, *(__global const lanes8 *)(luma + first));
            if (first == x)
                *(flanes *)(u + x) = position;
            else
                for (int lane = x - first; lane < 16; lane++)
                    u[first + lane] = position[lane];
        }
        x = column_end;
    }
}

/* One work-item a tile: depth[height][stride]. taps: from the Gaussian's centre outwards. With `linear` a position's
 * code is its number among the 65535 of depth_code.cl, and `codes` is not read. */
__kernel void slice_depth(__global const float *solution, __global const uchar *luma, __constant float *taps,
                          __global const ushort *codes, __global ushort *depth, int width, int height, int stride,
                          int planes, int linear)
{
    float u[(TILE_HEIGHT + 2 * RADIUS + 1) * STRIDE] __attribute__((aligned(64)));
    float rows[TOGETHER * STRIDE] __attribute__((aligned(64)));
    const int left = (int)get_group_id(0) * TILE_WIDTH, right = min(left + TILE_WIDTH, width);
    const int top = (int)get_group_id(1) * TILE_HEIGHT, bottom = min(top + TILE_HEIGHT, height);

    const int from = max(left - RADIUS, 0), to = min(right + RADIUS, width);
    for (int y = top - RADIUS; y < bottom + RADIUS; y++) {
        const int inside = mirror(y, height);
        float *row = u + (y - top + RADIUS) * STRIDE + ORIGIN - left;
        slice_row(solution + (inside / SIGMA_XY + 1) * ROW + COLUMN + 1, luma + (ulong)inside * width, width, from, to,
                  row);
        for (int x = left - RADIUS; x < from; x++)
            row[x] = row[min(-x, to - 1)];
        for (int x = to; x < right + RADIUS; x++)
            row[x] = row[max(2 * width - 2 - x, from)];
    }

    const float top_code = 65534.0f / (planes - 1);
    for (int y = top; y < bottom; y++) {
        if ((y - top) % TOGETHER == 0)
            for (int x = 0; x < ORIGIN + right - left + RADIUS; x += 16)
                blur_columns(u + (y - top) * STRIDE + x, taps, rows + x);
        const float *row = rows + (y - top) % TOGETHER * STRIDE;
        for (int x = 0; x < right - left; x += 16) {
            const float *centre = row + ORIGIN + x;
            float16 sum = taps[0] * *(const flanes *)centre;
            UNROLL_SMALL
            for (int i = 1; i <= RADIUS; i++)
                sum += taps[i] * symmetric_tap(centre, i);
            const float16 code = clamp(sum * top_code, 0.0f, 65534.0f) + 1.5f;
            const ushort16 coded = convert_ushort16(isnan(sum) ? (float16)0.0f : code);
            __global ushort *out = depth + (ulong)y * stride + left + x;
            const int inside = min(right - left - x, 16);
            if (linear && inside == 16)
                *(__global lanes16 *)out = coded;
            else
                for (int i = 0; i < inside; i++)
                    out[i] = linear ? coded[i] : codes[coded[i]];
        }
    }
}
