/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The tiles of focus_tiles.cl: their size, their copy of a plane's luma, and what is asked of memory ahead.
 */
#define TILE_WIDTH 384 /* a multiple of 192: whole blocks, whose coarse samples belong to one tile */
#define TILE_HEIGHT 36 /* a multiple of ROUND */
#define BLOCK 64       /* columns */
#define ROUND 12       /* rows after which the phases of all levels come round */
#define MARGIN_X 16    /* at least 2 LEVELS, whole lanes */
#define MARGIN_Y (2 * LEVELS)
#define ORIGIN 64      /* where a row of the tile begins in a row of its copy */
#define STRIDE (ORIGIN + TILE_WIDTH + 2 * BLOCK)
#define COARSE_STRIDE (TILE_WIDTH / 2 + 32)
#define COARSE_ROWS (TILE_HEIGHT / 2 + 4)
#define GRADIENT_LEVEL (COARSE_ROWS * COARSE_STRIDE) /* samples */

/* For vectors to be read and written at their own alignment: a load across two cache lines costs as much as two. */
#define SCRATCH __attribute__((aligned(64)))

/* The picture's part that a tile covers. */
typedef struct {
    int x, y;          /* the first pixel */
    int columns, rows; /* that lie in the picture */
    int whole_rows;    /* a multiple of ROUND, the last ones mirrored */
} Tile;

/* Copies a plane's tile with its margins, mirrored at the picture's borders. */
inline void load_tile(__global const uchar *plane, ulong stride, Tile tile, int width, int height, uchar *luma)
{
    const int left = max(tile.x - MARGIN_X, 0), right = min(tile.x + TILE_WIDTH + MARGIN_X, width);
    const int end = tile.x + tile.columns + MARGIN_X;
    for (int y = -MARGIN_Y; y < tile.whole_rows + MARGIN_Y; y++) {
        __global const uchar *row = plane + stride * (ulong)mirror(tile.y + y, height);
        uchar *copy = luma + (y + MARGIN_Y) * STRIDE + ORIGIN - tile.x;
        if (tile.x > 0)
            *(lanes8 *)(copy + tile.x - MARGIN_X) = *(__global const lanes8 *)(row + tile.x - MARGIN_X);
        for (int x = tile.x; x < right - 64; x += 64)
            *(bytes64 *)(copy + x) = *(__global const bytes64 *)(row + x);
        *(bytes64 *)(copy + right - 64) = *(__global const bytes64 *)(row + right - 64);
        for (int x = tile.x - MARGIN_X; x < 0; x++)
            copy[x] = copy[-x];
        for (int x = right; x < end; x++)
            copy[x] = copy[max(2 * width - 2 - x, left)];
    }
}

/* The tile that is measured next, to be asked for ahead: the same in the next plane, or the next one. */
typedef struct {
    __global const uchar *origin; /* its first pixel */
    ulong stride;
} Ahead;

inline Ahead tile_ahead(__global const uchar *stack, __global const ulong2 *table, Tile tile, int z, int planes,
                        int width)
{
    int2 first = (int2)(tile.x, tile.y);
    if (z + 1 == planes)
        first = tile.x + TILE_WIDTH < width ? (int2)(tile.x + TILE_WIDTH, tile.y) : (int2)(0, tile.y + TILE_HEIGHT);
    const ulong2 rows = table[z + 1 == planes ? 0 : z + 1];
    return (Ahead){stack + rows.x + rows.y * (ulong)first.y + first.x, rows.y};
}

/* Asks for a block's part of a row, the part right of it; with the first block for the left ones as well. */
inline void ask_for_part(__global const uchar *row, int block)
{
    PREFETCH(row + (block + 1) * BLOCK);
    if (block == 0) {
        PREFETCH(row);
        PREFETCH(row - BLOCK);
    }
}

/* Asks for row y, of the tile's own and those below, and for one of those above. */
inline void ask_for_row(Ahead ahead, int block, int y)
{
    ask_for_part(ahead.origin + ahead.stride * (y + MARGIN_Y), block);
    if (y < 2 * MARGIN_Y)
        ask_for_part(ahead.origin + ahead.stride * (y - MARGIN_Y), block);
}
