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
#define MARGIN_Y 8     /* at least 2 LEVELS */
#define ORIGIN 64      /* where a row of the tile begins in a row of its copy */
#define STRIDE (ORIGIN + TILE_WIDTH + 2 * BLOCK)
#define COARSE_STRIDE (TILE_WIDTH / 2 + 32)
#define COARSE_ROWS (TILE_HEIGHT / 2 + 4)
#define BLOCK_PIXELS (BLOCK * TILE_HEIGHT)
#define GRADIENT_LEVEL (COARSE_ROWS * COARSE_STRIDE) /* samples */
#define SPREAD_ROWS (TILE_HEIGHT / 2 + 2)
#define SPREAD_LEVEL (BLOCK * SPREAD_ROWS)

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
        for (int x = left; x < right - 32; x += 32)
            *(bytes32 *)(copy + x) = *(__global const bytes32 *)(row + x);
        *(bytes32 *)(copy + right - 32) = *(__global const bytes32 *)(row + right - 32);
        for (int x = tile.x - MARGIN_X; x < 0; x++)
            copy[x] = copy[-x];
        for (int x = right; x < end; x++)
            copy[x] = copy[max(2 * width - 2 - x, left)];
    }
}

/* Rows of the tile that is measured next, to be asked for ahead: of the same tile in the next plane, or of the next
 * tile. `row` begins MARGIN_Y rows below that tile's first one, and right of the columns it shares with the tile to the
 * left, which have been read before. */
typedef struct {
    __global const uchar *row;
    ulong stride;
} Ahead;

inline Ahead tile_ahead(__global const uchar *stack, __global const ulong2 *table, Tile tile, int z, int planes,
                        int width)
{
    int2 first = (int2)(tile.x, tile.y);
    if (z + 1 == planes)
        first = tile.x + TILE_WIDTH < width ? (int2)(tile.x + TILE_WIDTH, tile.y) : (int2)(0, tile.y + TILE_HEIGHT);
    const ulong2 rows = table[z + 1 == planes ? 0 : z + 1];
    return (Ahead){stack + rows.x + rows.y * (ulong)(first.y + MARGIN_Y) + first.x + BLOCK, rows.y};
}
