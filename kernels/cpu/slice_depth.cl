/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * For CPUs, tile by tile: the slice of bilateral_grid.cl, the Gaussian of gaussian_blur.cl and the coding of
 * depth_code.cl, 32 pixels at once. What differs: positions are cut to the planes before the Gaussian and are 16-bit
 * numbers from there on, 0..65534 as depth_code.cl counts them, which may turn out (RADIUS + 1) / 2 too high or too low
 * along y and as much along x.
 *
 * RADIUS taps on each side of the Gaussian's centre, and what luma_grid.cl says of the grid, are built in.
 */
#include "lanes32.cl"

#define TILE_WIDTH 960 /* multiple of 32 */
#define TILE_HEIGHT 64
#define AHEAD 4 /* rows of luma asked for ahead */
#define LAST 65534
#if RADIUS <= 24
#define UNROLL_SMALL __attribute__((opencl_unroll_hint))
#else
#define UNROLL_SMALL
#endif
#define MARGIN ((RADIUS + 31) / 32 * 32) /* beside the tile: whole lanes */
#define STRIDE (MARGIN + TILE_WIDTH + MARGIN)
#define TILE_COLUMNS ((TILE_WIDTH + 2 * RADIUS) / SIGMA_XY + 2) /* of the grid */

/* (a + b) / 2, halves rounded up: compilers know it as one instruction. */
INLINE ushort32 mean_of(ushort32 a, ushort32 b)
{
    return __builtin_convertvector((as_wide(a) + as_wide(b) + 1u) >> 1u, ushort32);
}

/* The Gaussian of 32 pixels, along x with a step of 1, along y with STRIDE. The weights are 65536 together and each
 * part is rounded down, so that nothing comes out above LAST. */
INLINE ushort32 blur(const ushort *centre, int step, const ushort32 *taps)
{
    ushort32 sum = part_of(*(const lanes32 *)centre, taps[0]) + (ushort)((RADIUS + 1) / 2);
    UNROLL_SMALL
    for (int i = 1; i <= RADIUS; i++)
        sum += part_of(mean_of(*(const lanes32 *)(centre - i * step), *(const lanes32 *)(centre + i * step)), taps[i]);
    return sum;
}

/* Codes of `count` cells of the grid, to be rounded down. */
INLINE void code_cells(__global const float *cells, float scale, int count, float *codes)
{
    for (int i = 0; i < count; i += 16)
        *(flanes *)(codes + i) = clamp(*(__global const flanes *)(cells + i) * scale, 0.0f, (float)LAST) + 0.5f;
}

/* Values of a table of 16 at `index`: the compiler's pattern for one permutation where the processor has it. */
INLINE float16 look_up(float16 table, int16 index)
{
    float16 found;
    __attribute__((opencl_unroll_hint))
    for (int i = 0; i < 16; i++)
        found[i] = table[index[i]];
    return found;
}

/* Codes of 16 pixels in one column of the grid, a cell for each step of luma. */
INLINE ushort16 slice_16(const float *column, uchar16 luma)
{
    const int16 step = convert_int16(luma) / SIGMA_LUMA;
#if COLUMN <= 17
    return convert_ushort16(look_up(*(const flanes *)column, step));
#else
    ushort lanes[16];
    for (int i = 0; i < 16; i++)
        lanes[i] = (ushort)column[step[i]];
    return *(const lanes16 *)lanes;
#endif
}

/* Slices the columns from..to of a row; codes: of the cells from the first one's column on. */
INLINE void slice_row(const float *codes, __global const uchar *luma, int width, int from, int to, ushort *u)
{
    int column_end = from / SIGMA_XY * SIGMA_XY + SIGMA_XY;
    for (int x = from; x < to; x = column_end, column_end += SIGMA_XY, codes += COLUMN)
        for (const int end = min(column_end, to); x < end; x += 16) {
            PREFETCH(luma + AHEAD * width + x);
            if (x <= width - 16) { /* the last lanes may be other columns', which write theirs later */
                *(lanes16 *)(u + x) = slice_16(codes, *(__global const lanes8 *)(luma + x));
            } else { /* the lanes before x come along */
                const ushort16 position = slice_16(codes, *(__global const lanes8 *)(luma + width - 16));
                for (int lane = x - (width - 16); lane < 16; lane++)
                    u[width - 16 + lane] = position[lane];
            }
        }
}

/* One work-item a tile: depth[height][stride]. weights: the Gaussian's, in parts of 65536; the centre's, then both at
 * a distance of 1, 2... With `linear` a position's code is its number among the 65535 of depth_code.cl, and `codes` is
 * not read. */
__kernel void slice_depth(__global const float *solution, __global const uchar *luma, __constant ushort *weights,
                          __global const ushort *codes, __global ushort *depth, int width, int height, int stride,
                          int planes, int linear)
{
    ushort u[(TILE_HEIGHT + 2 * RADIUS) * STRIDE] __attribute__((aligned(64)));
    ushort row[STRIDE] __attribute__((aligned(64)));
    float cells[TILE_COLUMNS * COLUMN + 16];
    const int left = (int)get_group_id(0) * TILE_WIDTH, right = min(left + TILE_WIDTH, width);
    const int top = (int)get_group_id(1) * TILE_HEIGHT, bottom = min(top + TILE_HEIGHT, height);
    const int is_known = !isnan(solution[ROW + COLUMN + 1]);

    const int from = max(left - RADIUS, 0), to = min(right + RADIUS, width);
    const int column = from / SIGMA_XY, columns = (to - 1) / SIGMA_XY + 1 - column;
    int grid_row = -1;
    for (int y = top - RADIUS; y < bottom + RADIUS; y++) {
        const int inside = mirror(y, height);
        if (inside / SIGMA_XY != grid_row) {
            grid_row = inside / SIGMA_XY;
            code_cells(solution + (grid_row + 1) * ROW + (column + 1) * COLUMN + 1, (float)LAST / (planes - 1),
                       columns * COLUMN, cells);
        }
        ushort *line = u + (y - top + RADIUS) * STRIDE + MARGIN - left;
        slice_row(cells, luma + (ulong)inside * width, width, from, to, line);
        for (int x = left - RADIUS; x < from; x++)
            line[x] = line[min(-x, to - 1)];
        for (int x = to; x < right + RADIUS; x++)
            line[x] = line[max(2 * width - 2 - x, from)];
    }

    ushort32 taps[RADIUS + 1];
    UNROLL_SMALL
    for (int i = 0; i <= RADIUS; i++)
        taps[i] = weights[i];
    for (int y = top; y < bottom; y++) {
        for (int x = 0; x < MARGIN + right - left + RADIUS; x += 32)
            *(lanes32 *)(row + x) = blur(u + (y - top + RADIUS) * STRIDE + x, STRIDE, taps);
        for (int x = 0; x < right - left; x += 32) {
            const ushort32 coded = is_known ? blur(row + MARGIN + x, 1, taps) + (ushort)1 : (ushort32)0;
            __global ushort *out = depth + (ulong)y * stride + left + x;
            const int inside = min(right - left - x, 32);
            if (linear && inside == 32)
                *(__global lanes32 *)out = coded;
            else
                for (int i = 0; i < inside; i++)
                    out[i] = linear ? coded[i] : codes[coded[i]];
        }
    }
}
