/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The focus measure of focus_measure.cl for CPUs: 32 lanes of 16-bit integers, one work-item a tile of the picture.
 * All planes of a tile are measured one after the other; the tile's luma, its coarse pictures and the best plane so
 * far stay in the core's cache. Luma has 8 bits; memory is little-endian.
 *
 * Columns are taken 64 at a time, even ones in one vector of 16-bit integers and odd ones in another; their halves, as
 * floats, hold every fourth column. That is how wide loads part bytes, pairs add up and coarse samples spread without a
 * shuffle. Such a block is measured from its first row to its last, between coarse gradients in registers. What is kept
 * between planes lies block by block, [block][row][column % 4][column / 4], so that walking down a block is walking
 * through memory.
 *
 * What differs from the formula:
 *  - the gradient's magnitude is max(m, 7/8 m + n/2) with m >= n the absolute derivatives: 3 % low to 0.8 % high;
 *  - gradients are integers in 1/8 DN (fine), 1/32 (1/2), 1/72 (1/3) and 1/128 DN (1/4);
 *  - the maximum has 8 bits of mantissa, and what differs by less than 2^-16 of it is equally sharp.
 */
#include "lanes32.cl"
#include "tile.cl"
#include "coarse_gradients.cl"
#include "stack_statistics.cl"

/* What one unit of the integer product is worth in P. */
#define FINE_UNIT (1.0f / 8)
#define COARSE_UNIT(level) (1.0f / (8 * (level) * (level) * UNITS(level) * UNITS(level)))

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
inline float16 product_of_levels(float16 gradient, const Between *coarse, int i, int phase)
{
    float16 product = gradient;
    __attribute__((opencl_unroll_hint))
    for (int level = 2; level <= LEVELS; level++)
        product *= upsample(coarse + level - 2, i, phase % level, level);
    return product;
}

/* The lowest bits of the best product so far hold LAST_PLACE less the place in half planes: of planes that are equally
 * sharp and next to each other, the middle. */
#define LAST_PLACE 127

/* What is kept between planes of 64 pixels in a row, [column % 4][column / 4]. */
typedef struct {
    int16 best[4];
    float16 sum[4]; /* of the products */
} Kept;

/* Takes the products of 16 pixels in plane z to what was kept before. */
inline void take(float16 product, int z, const Kept *before, Kept *kept, int i)
{
    const int16 candidate = (as_int16(product) & ~LAST_PLACE) | (LAST_PLACE - 2 * z);
    /* -1, half a plane farther, unless it is better than this one; if it is worse, it does not stay anyway. */
    const int16 not_better = before->best[i] <= (as_int16(product) | LAST_PLACE);
    kept->best[i] = max(before->best[i] + not_better, candidate);
    kept->sum[i] = before->sum[i] + product;
}

/* Takes 64 columns of a tile in plane z to what was kept `before`, whose next row is `step` farther. `row` is the one
 * above them, `gradients` are those of the tile's coarse pictures. */
inline void measure_block(const uchar *row, const ushort *gradients, int rows, int block, int z, Ahead ahead,
                          const Kept *before, int step, Kept *kept)
{
    Between coarse[LEVELS];
    __attribute__((opencl_unroll_hint))
    for (int level = 2; level <= LEVELS; level++)
        coarse[level - 2] = first_coarse_rows(gradients + (level - 2) * GRADIENT_LEVEL, block, level);
    Above even = {0, 0, {0, 0}}, odd = even;
    next_gradients(row, &even, &odd);
    next_gradients(row + STRIDE, &even, &odd);
    row += 2 * STRIDE;
    for (int y = 0; y < rows; y += ROUND) {
        __attribute__((opencl_unroll_hint))
        for (int phase = 0; phase < ROUND; phase++) {
            ask_for_row(ahead, block, y + phase);
            __attribute__((opencl_unroll_hint))
            for (int level = 2; level <= LEVELS; level++)
                if (phase % level == LOWER_HALF(level))
                    next_coarse_row(coarse + level - 2, block, level);
            const Columns fine = next_gradients(row, &even, &odd);
            const float16 columns[4] = {even_lanes(fine.even), even_lanes(fine.odd), odd_lanes(fine.even),
                                        odd_lanes(fine.odd)};
            __attribute__((opencl_unroll_hint))
            for (int i = 0; i < 4; i++)
                take(product_of_levels(columns[i], coarse, i, phase), z, before, kept, i);
            row += STRIDE;
            before += step;
            kept++;
        }
    }
}

/* Confidence of 16 pixels. */
inline int16 confidence_of(float16 peak, float16 mean, int planes)
{
    const float16 above = select((float16)0.0f, 1.0f - mean / peak, peak > 0.0f);
    return convert_int16(clamp(255.0f * above * planes / (planes - 1) + 0.5f, 0.0f, 255.0f));
}

/* The first `columns` of 64 bytes. */
inline void store_bytes(int16 bytes, __global uchar *out, int columns)
{
    if (columns >= BLOCK) {
        *(__global bytes64 *)out = __builtin_astype(bytes, uchar64);
        return;
    }
    uchar lanes[BLOCK];
    *(bytes64 *)lanes = __builtin_astype(bytes, uchar64);
    for (int i = 0; i < columns; i++)
        out[i] = lanes[i];
}

/* Pairs of columns, taken from `first` and `second` in turn, past the caches: nobody reads them before the whole
 * picture is done. */
inline void store_pairs(uint16 first, uint16 second, __global ushort *out)
{
    __global uint16 *lines = (__global uint16 *)out;
    const uint16 a =
        __builtin_shufflevector(first, second, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
    const uint16 b =
        __builtin_shufflevector(first, second, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
    __builtin_nontemporal_store(a, lines);
    __builtin_nontemporal_store(b, lines + 1);
}

/* Writes 64 pixels, of which `columns` lie in the picture, and returns the sum of their means. `unit` is what one of
 * the integer product is worth; without confidence its pointer is 0. */
inline float16 store_pixels(const Kept *kept, int columns, float unit, int planes, float tolerance,
                            __global ushort *peak, __global uchar *place, __global uchar *confidence)
{
    uint16 peaks[4];
    int16 found = 0, confident = 0;
    float16 total = 0.0f;
    __attribute__((opencl_unroll_hint))
    for (int i = 0; i < 4; i++) {
        const int16 inside = 4 * LANE + i < columns;
        const int16 bits = kept->best[i];
        const float16 p = as_float16(bits & ~LAST_PLACE & inside) * unit;
        const float16 mean = as_float16(as_int16(kept->sum[i]) & inside) * (unit / planes);
        peaks[i] = as_uint16(p);
        found |= select((int16)UNKNOWN_PLANE, LAST_PLACE - (bits & LAST_PLACE), p >= tolerance * mean) << 8 * i;
        total += mean;
        if (confidence)
            confident |= confidence_of(p, mean, planes) << 8 * i;
    }
    store_pairs(peaks[0] >> 16 | (peaks[1] & 0xffff0000u), peaks[2] >> 16 | (peaks[3] & 0xffff0000u), peak);
    __builtin_nontemporal_store(found, (__global int16 *)place);
    if (confidence)
        store_bytes(confident, confidence, columns);
    return total;
}

/* One work-item a tile. peak[height][stride]: max_z P as the upper half of a float; place likewise: where it is, in
 * half planes, UNKNOWN_PLANE where it is not `tolerance` times the mean over z; tile_sums: sum over a tile's pixels of the mean over
 * z. The stride is in pixels and a multiple of 64; peak is 0 behind the picture's columns. confidence[height][width]
 * as in sparse_depth.cl, if `with_confidence`; mean and moved as in stack_statistics.cl. */
__kernel void focus_tiles(__global const uchar *stack, __global const ulong2 *table, __global ushort *peak,
                          __global uchar *place, __global float *tile_sums, __global uchar *confidence,
                          __global uchar *mean_luma, __global uchar *moved, int stride, int width, int height,
                          int planes, float tolerance, float threshold_bits, int with_confidence)
{
    SCRATCH uchar luma[(TILE_HEIGHT + 2 * MARGIN_Y) * STRIDE];
    SCRATCH ushort sums[COARSE_ROWS * COARSE_STRIDE + 64];
    SCRATCH ushort gradients[(LEVELS > 1 ? LEVELS - 1 : 1) * GRADIENT_LEVEL];
    Kept kept[TILE_WIDTH / BLOCK * TILE_HEIGHT];
    const Kept nothing = {{0, 0, 0, 0}, {0, 0, 0, 0}};

    Tile tile;
    tile.x = (int)get_group_id(0) * TILE_WIDTH;
    tile.y = (int)get_group_id(1) * TILE_HEIGHT;
    tile.columns = min(TILE_WIDTH, width - tile.x);
    tile.rows = min(TILE_HEIGHT, height - tile.y);
    tile.whole_rows = (tile.rows + ROUND - 1) / ROUND * ROUND;

    for (int z = 0; z < planes; z++) {
        load_tile(stack + table[z].x, table[z].y, tile, width, height, luma);
        __attribute__((opencl_unroll_hint))
        for (int level = 2; level <= LEVELS; level++) {
            downsample(luma, tile, sums, level);
            coarse_gradient(sums, tile, gradients + (level - 2) * GRADIENT_LEVEL, level);
        }
        const Ahead ahead = tile_ahead(stack, table, tile, z, planes, width);
        for (int block = 0; block * BLOCK < tile.columns; block++) {
            Kept *of_block = kept + block * TILE_HEIGHT;
            measure_block(luma + (MARGIN_Y - 1) * STRIDE + ORIGIN + block * BLOCK, gradients, tile.whole_rows, block, z,
                          ahead, z > 0 ? of_block : &nothing, z > 0, of_block);
        }
    }
    tile_statistics(stack, table, tile, mean_luma, moved, width, planes, threshold_bits);

    float unit = FINE_UNIT;
    __attribute__((opencl_unroll_hint))
    for (int level = 2; level <= LEVELS; level++)
        unit *= COARSE_UNIT(level);
    float16 total = 0.0f;
    for (int y = 0; y < tile.rows; y++)
        for (int x = 0; x < tile.columns; x += BLOCK) {
            const ulong entry = (ulong)(tile.y + y) * stride + tile.x + x;
            const ulong pixel = (ulong)(tile.y + y) * width + tile.x + x;
            total += store_pixels(kept + x / BLOCK * TILE_HEIGHT + y, tile.columns - x, unit, planes, tolerance,
                                  peak + entry, place + entry, with_confidence ? confidence + pixel : 0);
        }
    tile_sums[get_group_id(1) * get_num_groups(0) + get_group_id(0)] = sum_of_lanes(total);
}
