/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The focus measure of focus_measure.cl for CPUs: 32 lanes of 16-bit integers, one work-item a tile of the picture.
 * All planes of a tile are measured one after the other; the tile's luma, its coarse pictures and the best plane so
 * far stay in the core's cache. Luma has 8 bits; memory is little-endian.
 *
 * Columns are taken 64 at a time, even ones in one vector of 16-bit integers and odd ones in another; their halves, as
 * floats, hold every fourth column. That is how wide loads part bytes, pairs add up and coarse samples spread without a
 * shuffle. What is kept between planes lies block by block, [block][row][column % 4][column / 4], so that walking down
 * a block is walking through memory.
 *
 * What differs from the formula:
 *  - the gradient's magnitude is max(m, 7/8 m + n/2) with m >= n the absolute derivatives: 3 % low to 0.8 % high;
 *  - gradients are integers in 1/8 DN (fine), 1/16 (1/2), 1/36 (1/3) and 1/4 DN (1/4);
 *  - R_{1/i} always averages i x i pixels and U_i spreads by i, so that at a size i does not divide the coarse picture
 *    is not stretched to the fine one;
 *  - beyond the border stands the fine picture, mirrored, at every level, which changes the outermost 2 LEVELS pixels;
 *  - the maximum has 8 bits of mantissa.
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
#define TILE_PIXELS (TILE_WIDTH * TILE_HEIGHT)
#define SPREAD_ROWS (TILE_HEIGHT / 2 + 2)
#define SPREAD_LEVEL (TILE_WIDTH * SPREAD_ROWS) /* samples */

/* For vectors to be read and written at their own alignment: a load across two cache lines costs as much as two. */
#define SCRATCH __attribute__((aligned(64)))

#include "lanes32.cl"

typedef ushort32 __attribute__((aligned(1))) byte_pairs; /* of 64 columns: even | odd << 8 */

inline ushort32 even_bytes(ushort32 pairs)
{
    return pairs & (ushort)255;
}

inline ushort32 odd_bytes(ushort32 pairs)
{
    return pairs >> (ushort)8;
}

inline float16 even_lanes(ushort32 v)
{
    return convert_float16(as_int16(v) & 65535);
}

inline float16 odd_lanes(ushort32 v)
{
    return convert_float16(as_int16(as_uint16(v) >> 16));
}

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

inline ushort32 magnitude(short32 dx, short32 dy)
{
    const short32 x = higher(dx, -dx), y = higher(dy, -dy);
    const short32 m = higher(x, y), n = lower(x, y);
    return as_ushort32(higher(m, m - (m >> (short)3) + (n >> (short)1)));
}

/* What Sobel's filter keeps of the two rows above, for 32 columns. */
typedef struct {
    short32 dx, dx_pair; /* derivative along x, and its sum over both rows */
    short32 smooth[2];   /* smoothing along x */
} Above;

/* The gradient around the row above, from the row at hand: its derivative and its smoothing along x. */
inline ushort32 next_gradient(short32 dx, short32 smooth, Above *above)
{
    const short32 dx_pair = above->dx + dx;
    const ushort32 gradient = magnitude(above->dx_pair + dx_pair, smooth - above->smooth[0]);
    above->dx = dx;
    above->dx_pair = dx_pair;
    above->smooth[0] = above->smooth[1];
    above->smooth[1] = smooth;
    return gradient;
}

/* Sums of neighbours, for 32 coarse samples. */
inline ushort32 sum_pairs(const uchar *row)
{
    const ushort32 pairs = *(const byte_pairs *)row;
    return even_bytes(pairs) + odd_bytes(pairs);
}

inline ushort32 sum_3(const ushort *row)
{
    return *(const lanes32 *)row + *(const lanes32 *)(row + 1) + *(const lanes32 *)(row + 2);
}

/* Indices of a shuffle: `of` each lane. */
#define LANES_4(of, i) of((i)), of((i) + 1), of((i) + 2), of((i) + 3)
#define LANES_8(of, i) LANES_4(of, i), LANES_4(of, (i) + 4)
#define LANES(of) LANES_8(of, 0), LANES_8(of, 8), LANES_8(of, 16), LANES_8(of, 24)

/* Every third of 96 lanes: 22 of the first two vectors, 10 of the last. */
#define THIRD_OF_A_B(i) ((i) < 22 ? 3 * (i) : 0)
#define THIRD_OF_AB_C(i) ((i) < 22 ? (i) : 3 * (i) - 32)

inline ushort32 sum_triples(const ushort *row)
{
    const ushort32 a = sum_3(row), b = sum_3(row + 32), c = sum_3(row + 64);
    const ushort32 ab = __builtin_shufflevector(a, b, LANES(THIRD_OF_A_B));
    return __builtin_shufflevector(ab, c, LANES(THIRD_OF_AB_C));
}

/* 16 sums of 4 x 4 pixels. */
inline ushort16 sum_quadruples(const uchar *row)
{
    const uint16 pairs = as_uint16(sum_pairs(row) + sum_pairs(row + STRIDE) + sum_pairs(row + 2 * STRIDE) +
                                   sum_pairs(row + 3 * STRIDE));
    return convert_ushort16((pairs & 65535u) + (pairs >> 16));
}

inline ushort32 sum_3_rows(const uchar *row)
{
    return widen(*(const bytes32 *)row) + widen(*(const bytes32 *)(row + STRIDE)) +
           widen(*(const bytes32 *)(row + 2 * STRIDE));
}

/* Sums of level x level pixels, from two coarse samples before the tile to two behind. */
inline void downsample(const uchar *luma, Tile tile, ushort *sums, int level)
{
    SCRATCH ushort row[STRIDE];
    const int columns = (tile.columns + level - 1) / level + 4, rows = tile.whole_rows / level + 4;
    for (int r = 0; r < rows; r++) {
        const uchar *fine = luma + (MARGIN_Y + (r - 2) * level) * STRIDE + ORIGIN - 2 * level;
        ushort *out = sums + r * COARSE_STRIDE;
        if (level == 2) {
            for (int c = 0; c < columns; c += 32)
                *(ushort32 *)(out + c) = sum_pairs(fine + 2 * c) + sum_pairs(fine + STRIDE + 2 * c);
        } else if (level == 3) {
            for (int x = 0; x < 3 * columns; x += 32)
                *(ushort32 *)(row + x) = sum_3_rows(fine + x);
            for (int c = 0; c < columns; c += 32)
                *(ushort32 *)(out + c) = sum_triples(row + 3 * c);
        } else {
            for (int c = 0; c < columns; c += 16)
                *(ushort16 *)(out + c) = sum_quadruples(fine + 4 * c);
        }
    }
}

/* Weights of bilinear upsampling in 1/UNITS: the farther of two coarse samples weighs FAR, the nearer the rest. */
#define UNITS(level) ((level) % 2 ? (level) : 2 * (level))
#define FAR(level, phase) (abs(2 * (phase) + 1 - (level)) >> ((level) % 2))

/* Keeps UNITS times the coarse gradient within 16 bits. */
#define GRADIENT_SHIFT(level) ((level) == 4 ? 5 : 1)

/* Even or odd columns of a block, out of a, b, c whose samples stand at columns % 3 = 0, 1, 2 from `phase` columns
 * before the block on: a and b are put in place first. */
#define FROM_A_B(column, i) ((column) % 3 * 32 % 64 + (column) / 3)
#define FROM_AB_C(column, i) ((column) % 3 == 2 ? 32 + (column) / 3 : (i))
#define EVEN_A_B(i) FROM_A_B(PHASE + 2 * (i), i)
#define EVEN_AB_C(i) FROM_AB_C(PHASE + 2 * (i), i)
#define ODD_A_B(i) FROM_A_B(PHASE + 2 * (i) + 1, i)
#define ODD_AB_C(i) FROM_AB_C(PHASE + 2 * (i) + 1, i)
#define MERGE_EVEN(a, b, c) \
    __builtin_shufflevector(__builtin_shufflevector(a, b, LANES(EVEN_A_B)), c, LANES(EVEN_AB_C))
#define MERGE_ODD(a, b, c) __builtin_shufflevector(__builtin_shufflevector(a, b, LANES(ODD_A_B)), c, LANES(ODD_AB_C))

typedef struct {
    ushort32 even, odd; /* columns */
} Columns;

inline Columns merge_triples(ushort32 a, ushort32 b, ushort32 c, int phase)
{
    switch (phase) {
#define PHASE 0
    case PHASE:
        return (Columns){MERGE_EVEN(a, b, c), MERGE_ODD(a, b, c)};
#undef PHASE
#define PHASE 1
    case PHASE:
        return (Columns){MERGE_EVEN(a, b, c), MERGE_ODD(a, b, c)};
#undef PHASE
#define PHASE 2
    default:
        return (Columns){MERGE_EVEN(a, b, c), MERGE_ODD(a, b, c)};
#undef PHASE
    }
}

/* One row of coarse gradients spread to the fine columns, in 1/UNITS. */
inline void spread_row(const ushort *gradient, float *fine, int columns, int level)
{
    for (int block = 0; block * BLOCK < columns; block++) {
        const ushort *first = gradient + block * BLOCK / level;
        const ushort32 before = *(const lanes32 *)first, here = *(const lanes32 *)(first + 1);
        const ushort32 after = *(const lanes32 *)(first + 2);
        float16 *out = (float16 *)(fine + block * SPREAD_ROWS * BLOCK);
        Columns spread;
        if (level == 2)
            spread = (Columns){here * (ushort)3 + before, here * (ushort)3 + after};
        else
            spread = merge_triples(here * (ushort)2 + before, here * (ushort)3, here * (ushort)2 + after, block % 3);
        out[0] = even_lanes(spread.even);
        out[1] = even_lanes(spread.odd);
        out[2] = odd_lanes(spread.even);
        out[3] = odd_lanes(spread.odd);
    }
}

/* The same at level 4, where the columns of a vector share their phase. */
inline void spread_row_of_quarters(const ushort *gradient, float *fine, int columns)
{
    for (int block = 0; block * BLOCK < columns; block++) {
        const ushort *first = gradient + block * BLOCK / 4;
        const float16 before = convert_float16(*(const lanes16 *)first);
        const float16 here = convert_float16(*(const lanes16 *)(first + 1));
        const float16 after = convert_float16(*(const lanes16 *)(first + 2));
        float16 *out = (float16 *)(fine + block * SPREAD_ROWS * BLOCK);
        out[0] = here * 5.0f + before * 3.0f;
        out[1] = here * 7.0f + before;
        out[2] = here * 7.0f + after;
        out[3] = here * 5.0f + after * 3.0f;
    }
}

/* Gradients of a coarse picture, from one row before the tile to one behind, each spread to the fine columns. */
inline void coarse_gradient(const ushort *sums, Tile tile, float *spread, int level)
{
    SCRATCH ushort gradient[COARSE_ROWS * COARSE_STRIDE];
    const int columns = (tile.columns + level - 1) / level + 2, rows = tile.whole_rows / level + 2;
    for (int c = 0; c < columns; c += 32) {
        Above above = {0, 0, {0, 0}};
        for (int r = -2; r < rows; r++) {
            const short *row = (const short *)sums + (r + 2) * COARSE_STRIDE + c;
            const short32 left = *(const slanes32 *)row, centre = *(const slanes32 *)(row + 1);
            const short32 right = *(const slanes32 *)(row + 2);
            const ushort32 g = next_gradient(right - left, left + right + (centre << (short)1), &above);
            if (r >= 0)
                *(ushort32 *)(gradient + r * COARSE_STRIDE + c) = g >> (ushort)GRADIENT_SHIFT(level);
        }
    }
    for (int r = 0; r < rows; r++)
        if (level == 4)
            spread_row_of_quarters(gradient + r * COARSE_STRIDE, spread + r * BLOCK, tile.columns);
        else
            spread_row(gradient + r * COARSE_STRIDE, spread + r * BLOCK, tile.columns, level);
}

/* The spread gradient in a fine row, `phase` rows below the one that the coarse row after `spread` begins with. */
inline float16 upsample(const float *spread, int phase, int level)
{
    const int k = phase / level, far_row = 2 * (phase % level) + 1 < level ? k : k + 2;
    const float far = FAR(level, phase % level), near = UNITS(level) - far;
    const float16 here = *(const float16 *)(spread + (k + 1) * BLOCK);
    return far == 0.0f ? here * near : here * near + *(const float16 *)(spread + far_row * BLOCK) * far;
}

/* What one unit of the integer product is worth in P. */
#define FINE_UNIT (1.0f / 8)
#define COARSE_UNIT(level) \
    ((float)(1 << GRADIENT_SHIFT(level)) / (8 * (level) * (level) * UNITS(level) * UNITS(level)))

inline Columns next_gradients(const uchar *row, Above *even, Above *odd)
{
    const ushort32 here = *(const byte_pairs *)row;
    const short32 b = as_short32(even_bytes(here)), c = as_short32(odd_bytes(here));
    const short32 a = as_short32(even_bytes(*(const byte_pairs *)(row - 1)));
    const short32 d = as_short32(odd_bytes(*(const byte_pairs *)(row + 1)));
    const short32 middle = b + c;
    return (Columns){next_gradient(c - a, a + b + middle, even), next_gradient(d - b, c + d + middle, odd)};
}

/* The product over the levels for 16 pixels in row `phase` of a round. */
inline float16 product_of_levels(float16 gradient, const float *spread, int y, int phase)
{
    float16 product = gradient;
    __attribute__((opencl_unroll_hint))
    for (int level = 2; level <= LEVELS; level++)
        product *= upsample(spread + (level - 2) * SPREAD_LEVEL + y / level * BLOCK, phase, level);
    return product;
}

/* The lowest bits of the best product so far hold LAST_PLANE - z. */
#define LAST_PLANE 63

/* Takes a product of plane z into the best one and the sum over the planes, for 16 pixels. */
inline void take(float16 product, int z, int *best, float *sum)
{
    const int16 candidate = (as_int16(product) & ~LAST_PLANE) | (LAST_PLANE - z);
    *(int16 *)best = max(*(int16 *)best, candidate);
    *(float16 *)sum += product;
}

/* Rows of the tile that is measured next, to be asked for ahead: of the same tile in the next plane, or of the next
 * tile. Those shared with the tiles above and to the left have been read before. */
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

/* Takes plane z of a tile into the best product and the sum over the planes. */
inline void measure_plane(const uchar *luma, Tile tile, const float *spread, int z, Ahead ahead, int *best, float *sum)
{
    for (int block = 0; block * BLOCK < tile.columns; block++) {
        __global const uchar *next = ahead.row + block * BLOCK;
        Above even = {0, 0, {0, 0}}, odd = even;
        const uchar *row = luma + (MARGIN_Y - 1) * STRIDE + ORIGIN + block * BLOCK;
        next_gradients(row, &even, &odd);
        next_gradients(row + STRIDE, &even, &odd);
        row += 2 * STRIDE;
        const float *block_spread = spread + block * SPREAD_ROWS * BLOCK;
        int pixel = block * TILE_HEIGHT * BLOCK;
        for (int y = 0; y < tile.whole_rows; y += ROUND) {
            __attribute__((opencl_unroll_hint))
            for (int phase = 0; phase < ROUND; phase++) {
                PREFETCH(next);
                if (y + phase < 2 * MARGIN_Y)
                    PREFETCH(next - ahead.stride * (2 * MARGIN_Y));
                next += ahead.stride;
                const Columns fine = next_gradients(row, &even, &odd);
                const float16 columns[4] = {even_lanes(fine.even), even_lanes(fine.odd), odd_lanes(fine.even),
                                            odd_lanes(fine.odd)};
                __attribute__((opencl_unroll_hint))
                for (int i = 0; i < 4; i++, pixel += 16)
                    take(product_of_levels(columns[i], block_spread + 16 * i, y, phase), z, best + pixel, sum + pixel);
                row += STRIDE;
            }
        }
    }
}

inline float sum_of_lanes(float16 v)
{
    const float8 a = v.lo + v.hi;
    const float4 b = a.lo + a.hi;
    const float2 c = b.lo + b.hi;
    return c.lo + c.hi;
}

/* Confidence of 16 pixels, of which `columns` lie in the picture. */
inline void store_confidence(float16 peak, float16 mean, int planes, __global uchar *confidence, int columns)
{
    const float16 above = select((float16)0.0f, 1.0f - mean / peak, peak > 0.0f);
    uchar lanes[16];
    *(lanes8 *)lanes = convert_uchar16(clamp(255.0f * above * planes / (planes - 1) + 0.5f, 0.0f, 255.0f));
    for (int i = 0; i < min(columns, 16); i++)
        confidence[i] = lanes[i];
}

/* 16 pixels from column x on, out of a tile's blocks. */
inline int16 pixels_at(const int *blocks, int x, int y)
{
    const int *columns = blocks + (x / BLOCK * TILE_HEIGHT + y) * BLOCK + x % BLOCK / 4;
    const int4 a = *(const int4 *)columns, b = *(const int4 *)(columns + 16);
    const int4 c = *(const int4 *)(columns + 32), d = *(const int4 *)(columns + 48);
    const int8 ab = __builtin_shufflevector(a, b, 0, 4, 1, 5, 2, 6, 3, 7);
    const int8 cd = __builtin_shufflevector(c, d, 0, 4, 1, 5, 2, 6, 3, 7);
    return __builtin_shufflevector(ab, cd, 0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15);
}

/* One work-item a tile. peak[height][stride]: max_z P as the upper half of a float; peak_plane likewise: where it is,
 * UNKNOWN_PLANE where it is not `tolerance` times the mean over z; tile_sums: sum over a tile's pixels of the mean over
 * z. The stride is in pixels and holds whole lanes; peak is 0 behind the picture's columns. confidence[height][width]
 * as in sparse_depth.cl, if `with_confidence`. */
__kernel void focus_tiles(__global const uchar *stack, __global const ulong2 *table, __global ushort *peak,
                          __global uchar *peak_plane, __global float *tile_sums, __global uchar *confidence, int stride,
                          int width, int height, int planes, float tolerance, int with_confidence)
{
    SCRATCH uchar luma[(TILE_HEIGHT + 2 * MARGIN_Y) * STRIDE];
    SCRATCH ushort sums[COARSE_ROWS * COARSE_STRIDE + 64];
    SCRATCH float spread[(LEVELS > 1 ? LEVELS - 1 : 1) * SPREAD_LEVEL];
    SCRATCH int best[TILE_PIXELS];
    SCRATCH float sum[TILE_PIXELS];

    Tile tile;
    tile.x = (int)get_group_id(0) * TILE_WIDTH;
    tile.y = (int)get_group_id(1) * TILE_HEIGHT;
    tile.columns = min(TILE_WIDTH, width - tile.x);
    tile.rows = min(TILE_HEIGHT, height - tile.y);
    tile.whole_rows = (tile.rows + ROUND - 1) / ROUND * ROUND;

    for (int i = 0; i < TILE_PIXELS; i += 16) {
        *(int16 *)(best + i) = 0;
        *(float16 *)(sum + i) = 0.0f;
    }
    for (int z = 0; z < planes; z++) {
        load_tile(stack + table[z].x, table[z].y, tile, width, height, luma);
        __attribute__((opencl_unroll_hint))
        for (int level = 2; level <= LEVELS; level++) {
            downsample(luma, tile, sums, level);
            coarse_gradient(sums, tile, spread + (level - 2) * SPREAD_LEVEL, level);
        }
        measure_plane(luma, tile, spread, z, tile_ahead(stack, table, tile, z, planes, width), best, sum);
    }

    float unit = FINE_UNIT;
    __attribute__((opencl_unroll_hint))
    for (int level = 2; level <= LEVELS; level++)
        unit *= COARSE_UNIT(level);
    float16 total = 0.0f;
    for (int y = 0; y < tile.rows; y++)
        for (int x = 0; x < tile.columns; x += 16) {
            const ulong pixel = (ulong)(tile.y + y) * stride + tile.x + x;
            const int16 bits = pixels_at(best, x, y);
            const int16 inside = LANE < tile.columns - x;
            const float16 p = as_float16(bits & ~LAST_PLANE & inside) * unit;
            const float16 mean = as_float16(pixels_at((const int *)sum, x, y) & inside) * (unit / planes);
            const int16 plane = LAST_PLANE - (bits & LAST_PLANE);
            const int16 sharp = p >= tolerance * mean;
            total += mean;
            *(__global lanes16 *)(peak + pixel) = convert_ushort16(as_uint16(p) >> 16);
            *(__global lanes8 *)(peak_plane + pixel) = convert_uchar16(select((int16)UNKNOWN_PLANE, plane, sharp));
            if (with_confidence)
                store_confidence(p, mean, planes, confidence + (ulong)(tile.y + y) * width + tile.x + x,
                                 tile.columns - x);
        }
    tile_sums[get_group_id(1) * get_num_groups(0) + get_group_id(0)] = sum_of_lanes(total);
}
