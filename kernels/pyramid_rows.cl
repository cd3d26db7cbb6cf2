/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Included by sharp_weights.cl and sharp_blend.cl: pictures at 1/2, 1/4, .. of the stack's resolution. Level 0 is the
 * stack itself; a cell of level l + 1 lies over 2 x 2 of level l, so that level l has ceil(width / 2^l) columns.
 *
 * A picture of a level is T[height][stride], cell (x, y) at y * stride + SIDE + x; a volume is one such picture a plane.
 * Beside the ends of a row stand MARGIN copies of its last cells. A work-item makes 16 cells of a row, the first of them
 * at a multiple of 16, in one vector: a register or two of a CPU's, and many work-items for a GPU.
 */
#ifndef INLINE /* a simulator may know better */
#define INLINE inline __attribute__((always_inline))
#endif

#define SIDE 16
#define MARGIN 2

typedef struct {
    int width, height, stride; /* cells */
} Level;

INLINE ulong row_of(Level level, int picture, int y)
{
    return ((ulong)picture * level.height + clamp(y, 0, level.height - 1)) * level.stride + SIDE;
}

/* Writes 16 cells from x on, and the margins if they are at an end. */
#define STORE_CELLS(T, vector, lanes)                                                                                  \
    INLINE void __attribute__((overloadable)) store_cells(__global T *row, int x, int width, vector cells)             \
    {                                                                                                                  \
        *(__global lanes *)(row + x) = cells;                                                                          \
        if (x == 0)                                                                                                    \
            for (int i = 1; i <= MARGIN; i++)                                                                          \
                row[-i] = row[0];                                                                                      \
        if (x + 16 >= width)                                                                                           \
            for (int i = width; i < x + 16 + MARGIN; i++)                                                              \
                row[i] = row[width - 1];                                                                               \
    }
STORE_CELLS(uchar, uchar16, lanes8)
STORE_CELLS(ushort, ushort16, lanes16)
STORE_CELLS(float, float16, flanes)

/* 16 numbers of a row of `width` that has no margins, from x on, wherever that is: outside stand the row's ends. */
#define LOAD_CLAMPED(T, vector, lanes)                                                                                 \
    INLINE vector __attribute__((overloadable)) load_clamped(__global const T *row, int x, int width)                  \
    {                                                                                                                  \
        if (x >= 0 && x + 16 <= width)                                                                                 \
            return *(__global const lanes *)(row + x);                                                                 \
        T cells[16];                                                                                                   \
        for (int i = 0; i < 16; i++)                                                                                   \
            cells[i] = row[clamp(x + i, 0, width - 1)];                                                                \
        return vload16(0, cells);                                                                                      \
    }
LOAD_CLAMPED(uchar, uchar16, lanes8)
LOAD_CLAMPED(ushort, ushort16, lanes16)

/* Where 16 cells of level l from x on, a multiple of 16, lie in level l + 1: between these two of its rows, three parts
 * to the first and one to the other. */
typedef struct {
    ulong near, far;
} CoarseRows;

INLINE CoarseRows coarse_rows(Level coarse, int picture, int x, int y)
{
    const int beside = y & 1 ? y / 2 + 1 : y / 2 - 1;
    const CoarseRows rows = {row_of(coarse, picture, y / 2) + x / 2 - 1, row_of(coarse, picture, beside) + x / 2 - 1};
    return rows;
}

/* Three parts of the cell that a cell lies in, one of the one it lies next to, in both directions. */
INLINE float16 spread_along(float16 cells)
{
    return 0.75f * cells.s1122334455667788 + 0.25f * cells.s0213243546576879;
}

INLINE float16 __attribute__((overloadable)) upsampled(__global const uchar *picture, CoarseRows rows)
{
    return spread_along(0.75f * convert_float16(*(__global const lanes8 *)(picture + rows.near)) +
                        0.25f * convert_float16(*(__global const lanes8 *)(picture + rows.far)));
}

INLINE float16 __attribute__((overloadable)) upsampled(__global const ushort *picture, CoarseRows rows)
{
    return spread_along(0.75f * convert_float16(*(__global const lanes16 *)(picture + rows.near)) +
                        0.25f * convert_float16(*(__global const lanes16 *)(picture + rows.far)));
}

INLINE float16 __attribute__((overloadable)) upsampled(__global const float *picture, CoarseRows rows)
{
    return spread_along(0.75f * *(__global const flanes *)(picture + rows.near) +
                        0.25f * *(__global const flanes *)(picture + rows.far));
}
