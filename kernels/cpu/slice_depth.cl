/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * For CPUs, tile by tile: the slice of bilateral_grid.cl, the Gaussian of gaussian_blur.cl and the coding of
 * depth_code.cl. RADIUS taps on each side of the Gaussian's centre, and the grid's COLUMN and ROW of luma_grid.cl, are
 * built in.
 */
#define TILE_WIDTH 256 /* multiple of 16 */
#define TILE_HEIGHT 64
#define TOGETHER 4 /* rows blurred at once, a divisor of TILE_HEIGHT */
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

inline int lowest(uchar16 v)
{
    const uchar8 a = min(v.lo, v.hi);
    const uchar4 b = min(a.lo, a.hi);
    const uchar2 c = min(b.lo, b.hi);
    return min(c.lo, c.hi);
}

/* Slices rows y to end (mirrored) of the 16 columns from x on, which take `column`, a cell for each step of luma. Of
 * the cells only those between the darkest and the brightest pixel are looked at; the last lanes may be other columns',
 * which write theirs later. */
inline void slice_cells(__global const uchar *luma, int width, int height, int x, int y, int end,
                        __global const float *column, int sigma_luma, float *u)
{
    const int first = min(x, width - 16); /* at the right border the lanes before x come along */
    uchar16 darkest = 255, brightest = 0;
    for (int i = y; i < end; i++) {
        const uchar16 row = *(__global const lanes8 *)(luma + (ulong)mirror(i, height) * width + first);
        darkest = min(darkest, row);
        brightest = max(brightest, row);
    }
    const int from = lowest(darkest) / sigma_luma, to = (255 - lowest(~brightest)) / sigma_luma;
    for (int i = y; i < end; i++, u += STRIDE) {
        const uchar16 row = *(__global const lanes8 *)(luma + (ulong)mirror(i, height) * width + first);
        float16 position = column[from];
        for (int step = from + 1; step <= to; step++)
            position = select(position, (float16)column[step],
                              convert_int16(row >= (uchar16)(uchar)(step * sigma_luma)));
        if (first == x)
            *(flanes *)(u + x) = position;
        else
            for (int lane = x - first; lane < 16; lane++)
                u[first + lane] = ((const float *)&position)[lane];
    }
}

/* One work-item a tile: depth[height][stride]. taps: from the Gaussian's centre outwards. With `linear` a position's
 * code is its number among the 65535 of depth_code.cl, and `codes` is not read. */
__kernel void slice_depth(__global const float *solution, __global const uchar *luma, __constant float *taps,
                          __global const ushort *codes, __global ushort *depth, int width, int height, int stride,
                          int sigma_xy, int sigma_luma, int planes, int linear)
{
    float u[(TILE_HEIGHT + 2 * RADIUS + 1) * STRIDE] __attribute__((aligned(64)));
    float rows[TOGETHER * STRIDE] __attribute__((aligned(64)));
    const int left = (int)get_group_id(0) * TILE_WIDTH, right = min(left + TILE_WIDTH, width);
    const int top = (int)get_group_id(1) * TILE_HEIGHT, bottom = min(top + TILE_HEIGHT, height);

    for (int y = top - RADIUS; y < bottom + RADIUS;) {
        const int cell_row = mirror(y, height) / sigma_xy;
        int end = y + 1;
        while (end < bottom + RADIUS && mirror(end, height) / sigma_xy == cell_row)
            end++;
        __global const float *cells = solution + (cell_row + 1) * ROW + COLUMN + 1;
        const int from = max(left - RADIUS, 0), to = min(right + RADIUS, width);
        float *out = u + (y - top + RADIUS) * STRIDE + ORIGIN - left;
        for (int x = from; x < to;) {
            const int column_end = min((x / sigma_xy + 1) * sigma_xy, to);
            for (; x < column_end; x += 16)
                slice_cells(luma, width, height, x, y, end, cells + x / sigma_xy * COLUMN, sigma_luma, out);
            x = column_end;
        }
        for (; y < end; y++, out += STRIDE) {
            for (int x = left - RADIUS; x < from; x++)
                out[x] = out[min(-x, to - 1)];
            for (int x = to; x < right + RADIUS; x++)
                out[x] = out[max(2 * width - 2 - x, from)];
        }
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
            ushort lanes[16];
            *(lanes16 *)lanes = convert_ushort16(isnan(sum) ? (float16)0.0f : code);
            __global ushort *out = depth + (ulong)y * stride + left + x;
            const int inside = min(right - left - x, 16);
            if (!linear)
                for (int i = 0; i < inside; i++)
                    lanes[i] = codes[lanes[i]];
            if (inside == 16)
                *(__global lanes16 *)out = *(lanes16 *)lanes;
            else
                for (int i = 0; i < inside; i++)
                    out[i] = lanes[i];
        }
    }
}
