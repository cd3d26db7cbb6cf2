/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * stack_denoise.cl for CPUs and samples of 8 bits: the same in 32 lanes of 16 bits, and in one pass over the memory, which
 * is what takes the time (a stack of I420 and its means are three times its bytes, and all of it is read and written).
 *
 * A work-item has a strip of `strip` rows of tiles, from above to below: a row of tiles is judged in all planes, then the row
 * above it averaged while the caches still hold it. Since the strips work in place, the first and the last row of each strip,
 * to which the neighbours look, are judged before all strips (judge_borders).
 *
 * Means are in 1/128, at most 32640, so that sample - mean fits into 16 bits with its sign; differences are summed up in
 * 1/16. A component c of COMPONENTS has tiles of TILEc samples in ROWSc rows.
 */
#include "lanes32.cl"

#define BRIGHTNESSES 256
#define SHARES(count) ((count) + 16) /* room for those of a row of tiles, which are read eight at once */
#define AHEAD 192 /* samples that are asked for early */
#define NEW_SCENE ((short)-1) /* a part: the mean begins anew with this sample */
#define HELD ((short)-2)      /* a part: the mean stays, and the sample too */

typedef short8 __attribute__((aligned(2))) short8u;
typedef short4 __attribute__((aligned(2))) short4u;

/* One component of one plane. */
typedef struct {
    __global uchar *samples;
    ulong stride;
    __global short *means;
    int width, height;
} Part;

/* a b / 32768, rounded. */
INLINE short32 rounded_part_of(short32 a, short32 b)
{
#if defined __AVX512BW__
    return __builtin_ia32_pmulhrsw512(a, b);
#elif defined __AVX2__
    const short16 low = __builtin_ia32_pmulhrsw256(a.lo, b.lo), high = __builtin_ia32_pmulhrsw256(a.hi, b.hi);
    return (short32)(low, high);
#else
    typedef int __attribute__((ext_vector_type(32))) int32;
    const int32 product = __builtin_convertvector(a, int32) * __builtin_convertvector(b, int32);
    return __builtin_convertvector((product + 16384) >> 15, short32);
#endif
}

/* Products of lanes, added in pairs of neighbours. */
INLINE int16 product_of_pairs(short32 a, short32 b)
{
#if defined __AVX512BW__
    return __builtin_ia32_pmaddwd512(a, b);
#elif defined __AVX2__
    const int8 low = __builtin_ia32_pmaddwd256(a.lo, b.lo), high = __builtin_ia32_pmaddwd256(a.hi, b.hi);
    return (int16)(low, high);
#else
    return convert_int16(a.even) * convert_int16(b.even) + convert_int16(a.odd) * convert_int16(b.odd);
#endif
}

INLINE short32 load_samples(__global const uchar *samples)
{
    return __builtin_convertvector(*(__global const bytes32 *)samples, short32) << (short)7;
}

/* Of pairs of columns, or of more of them: of sample - mean its sum and square, and of the mean. */
typedef struct {
    int16 sum, light;
    float16 square;
} Sums;

/* What 16 tiles tell: of sample - mean the mean and the mean square, and the mean of the mean. */
typedef struct {
    float16 mean, square, light;
} Tiles;

#define PAIRS(a, b)                                                                                                    \
    (__builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30) +                        \
     __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31))

/* Neighbours added up: a's lanes first. */
INLINE Sums joined(Sums a, Sums b)
{
    return (Sums){PAIRS(a.sum, b.sum), PAIRS(a.light, b.light), PAIRS(a.square, b.square)};
}

/* Of 32 columns from x on. */
INLINE Sums sums_of_32(Part part, const int rows, int y0, int x)
{
    short32 sum = 0, light = 0;
    int16 square = 0;
    for (int y = y0; y < y0 + rows; y++) {
        __global const short *means = part.means + (long)y * part.width + x;
        __global const uchar *samples = part.samples + (ulong)y * part.stride + x;
        PREFETCH(means + AHEAD);
        PREFETCH(samples + AHEAD);
        const short32 mean = *(__global const slanes32 *)means, sample = load_samples(samples);
        const short32 difference = (sample - mean + (short)4) >> (short)3;
        sum += difference;
        square += product_of_pairs(difference, difference);
        light += mean >> (short)3;
    }
    return (Sums){product_of_pairs(sum, (short32)1), product_of_pairs(light, (short32)1), convert_float16(square)};
}

INLINE Sums sums_of_64(Part part, const int rows, int y0, int x)
{
    return joined(sums_of_32(part, rows, y0, x), sums_of_32(part, rows, y0, x + 32));
}

INLINE Sums sums_of_128(Part part, const int rows, int y0, int x)
{
    return joined(sums_of_64(part, rows, y0, x), sums_of_64(part, rows, y0, x + 64));
}

INLINE Sums sums_of_512(Part part, const int rows, int y0, int x)
{
    return joined(joined(sums_of_128(part, rows, y0, x), sums_of_128(part, rows, y0, x + 128)),
                  joined(sums_of_128(part, rows, y0, x + 256), sums_of_128(part, rows, y0, x + 384)));
}

/* Of 16 tiles of 24 samples, which is no power of two. */
INLINE Sums sums_of_384(Part part, const int rows, int y0, int x)
{
    int sums[192], lights[192]; /* of pairs of columns */
    float squares[192];
    for (int v = 0; v < 12; v++) {
        const Sums pairs = sums_of_32(part, rows, y0, x + 32 * v);
        for (int i = 0; i < 16; i++) {
            sums[16 * v + i] = pairs.sum[i];
            lights[16 * v + i] = pairs.light[i];
            squares[16 * v + i] = pairs.square[i];
        }
    }
    Sums all = {0, 0, 0.0f};
    for (int t = 0; t < 16; t++)
        for (int i = 12 * t; i < 12 * t + 12; i++) {
            all.sum[t] += sums[i];
            all.light[t] += lights[i];
            all.square[t] += squares[i];
        }
    return all;
}

/* 16 whole tiles from sample x on, TILES_A_TIME. */
INLINE Tiles measure_tiles(Part part, const int tile, const int rows, int y0, int x)
{
    const Sums sums = tile == 4    ? sums_of_64(part, rows, y0, x)
                      : tile == 8  ? sums_of_128(part, rows, y0, x)
                      : tile == 24 ? sums_of_384(part, rows, y0, x)
                                   : sums_of_512(part, rows, y0, x);
    const float unit = 1.0f / (16.0f * tile * rows);
    return (Tiles){convert_float16(sums.sum) * unit, sums.square * (unit / 16.0f), convert_float16(sums.light) * unit};
}

/* One tile: mean, square and light. */
INLINE float4 measure_tile(Part part, const int tile, const int rows, int y0, int x0)
{
    float sum = 0.0f, square = 0.0f, light = 0.0f;
    for (int y = y0; y < y0 + rows; y++)
        for (int x = x0; x < x0 + tile; x++) {
            const float mean = part.means[(long)y * part.width + x] / 128.0f;
            const float difference = part.samples[(ulong)y * part.stride + x] - mean;
            sum += difference;
            square += difference * difference;
            light += mean;
        }
    return (float4)(sum, square, light, 0.0f) / (float)(tile * rows);
}

/* A row of tiles: 16 at a time, the last of which may be among those before, as far as they are whole; then one by one. */
#define FOR_WHOLE_TILES(tx, whole)                                                                                     \
    for (int tx = 0; whole >= 16 && tx < whole; tx = tx + 16 < whole ? min(tx + 16, whole - 16) : whole)
#define FOR_OTHER_TILES(tx, whole, count) for (int tx = whole >= 16 ? whole : 0; tx < count; tx++)

/* out[tile], as tiles[] of stack_denoise.cl. */
INLINE void measure_row(Part part, const int tile, const int rows, int ty, int count, __global float4 *out)
{
    const int y0 = min(ty * rows, part.height - rows), whole = part.width / tile;
    FOR_WHOLE_TILES(tx, whole)
    {
        const Tiles tiles = measure_tiles(part, tile, rows, y0, tx * tile);
        for (int i = 0; i < 16; i++)
            out[tx + i] = (float4)(tiles.mean[i], tiles.square[i], tiles.light[i], 0.0f);
    }
    FOR_OTHER_TILES(tx, whole, count)
    out[tx] = measure_tile(part, tile, rows, y0, min(tx * tile, part.width - tile));
}

/* How far a tile may be off. most[brightness]: its mean, and its mean square, by noise of one sweep; of_sweeps[k]: by how
 * much more where the mean of k sweeps is compared, for either. */
INLINE float2 bound_of(float light, uchar sweeps, __global const float2 *most, __global const float2 *of_sweeps,
                       float least)
{
    return most[clamp((int)light, 0, BRIGHTNESSES - 1)] * of_sweeps[sweeps] + least;
}

/* Adds to moved[] which tiles of a row moved and are not held. */
INLINE void judge_row(Part part, const int tile, const int rows, int ty, int count, __global const uchar *sweeps,
                      __global const uchar *held, __global const float2 *most, __global const float2 *of_sweeps,
                      float least, __global uchar *moved)
{
    const int y0 = min(ty * rows, part.height - rows), whole = part.width / tile;
    FOR_WHOLE_TILES(tx, whole)
    {
        const Tiles tiles = measure_tiles(part, tile, rows, y0, tx * tile);
        float16 of_mean, of_square;
        for (int i = 0; i < 16; i++) {
            const float2 bound = bound_of(tiles.light[i], sweeps[tx + i], most, of_sweeps, least);
            ((float *)&of_mean)[i] = bound.x;
            ((float *)&of_square)[i] = bound.y;
        }
        const int16 far = fabs(tiles.mean) > of_mean || tiles.square > of_square;
        const int8 eight = far.lo | far.hi;
        const int4 four = eight.lo | eight.hi;
        if (four.x | four.y | four.z | four.w)
            for (int i = 0; i < 16; i++)
                moved[tx + i] |= far[i] && !held[tx + i];
    }
    FOR_OTHER_TILES(tx, whole, count)
    {
        const float4 alone = measure_tile(part, tile, rows, y0, min(tx * tile, part.width - tile));
        const float2 bound = bound_of(alone.z, sweeps[tx], most, of_sweeps, least);
        moved[tx] |= (fabs(alone.x) > bound.x || alone.y > bound.y) && !held[tx];
    }
}

/* near[tile] of a row of tiles: that one moved, or one around it. */
INLINE void look_around(__global const uchar *moved, int ty, int2 count, __global uchar *near)
{
    __global const uchar *above = moved + (long)max(ty - 1, 0) * count.x, *here = moved + (long)ty * count.x;
    __global const uchar *below = moved + (long)min(ty + 1, count.y - 1) * count.x;
    uchar left = 0, middle = above[0] | here[0] | below[0];
    for (int tx = 0; tx < count.x; tx++) {
        const uchar right = tx + 1 < count.x ? above[tx + 1] | here[tx + 1] | below[tx + 1] : 0;
        near[tx] = left | middle | right;
        left = middle;
        middle = right;
    }
}

/* sweeps[tile] of a row of tiles becomes k, stack_denoise.cl's count_sweeps(), unless nothing is `wanted` of the plane;
 * shares[tile] what average_row() does there, of[k] for the mean of k sweeps. Gives whether any of them is no share. */
INLINE int count_row(__global const uchar *near, __global const uchar *held, __global const short *of, int count,
                     int frames, int is_wanted, __global uchar *sweeps, __global short *shares)
{
    int special = 0;
    for (int tx = 0; tx < count; tx++) {
        const int k = !is_wanted || held[tx] ? sweeps[tx] : near[tx] ? 1 : min(sweeps[tx] + 1, frames);
        const short share = held[tx] ? HELD : is_wanted ? of[k] : (short)0;
        sweeps[tx] = (uchar)k;
        shares[tx] = share;
        special |= share < 0;
    }
    return special;
}

/* The parts of 32 samples of tiles of 4, 8 or 32. */
INLINE short32 shares_of(__global const short *shares, const int tile)
{
    if (tile == 4) {
        const short8 s = *(__global const short8u *)shares;
        return __builtin_shufflevector(s, s, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 6, 6,
                                       6, 6, 7, 7, 7, 7);
    }
    if (tile == 8) {
        const short4 s = *(__global const short4u *)shares;
        return __builtin_shufflevector(s, s, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 3, 3,
                                       3, 3, 3, 3, 3, 3);
    }
    return *shares;
}

/* The means and samples of 32 columns in a row. */
INLINE void average_32(__global short *means, __global uchar *samples, short32 share, const int is_special)
{
    const short32 sample = load_samples(samples), mean = *(__global const slanes32 *)means;
    const short32 average = mean + rounded_part_of(sample - mean, share);
    const short32 next = !is_special ? average : share == NEW_SCENE ? sample : share == HELD ? mean : average;
    const short32 shown = !is_special ? next : share == HELD ? sample : next;
    *(__global slanes32 *)means = next;
    *(__global bytes32 *)samples = __builtin_convertvector((shown + (short)64) >> (short)7, uchar32);
}

/* A row of tiles. parts[] is room for a row of samples of tiles of 24. */
INLINE void average_row(Part part, const int tile, const int rows, int ty, int count, __global const short *shares,
                        const int is_special, __global short *parts)
{
    if (tile == 24)
        for (int tx = 0; tx < count; tx++)
            for (int x = tx * tile; x < tx * tile + tile; x += 4)
                *(__global short4u *)(parts + x) = shares[tx];
    const int whole = part.width / 32 * 32;
    for (int y = ty * rows; y < min(ty * rows + rows, part.height); y++) {
        __global short *means = part.means + (long)y * part.width;
        __global uchar *samples = part.samples + (ulong)y * part.stride;
        for (int x = 0; x < whole; x += 32)
            average_32(means + x, samples + x,
                       tile == 24 ? *(__global const slanes32 *)(parts + x) : shares_of(shares + x / tile, tile),
                       is_special);
        for (int x = whole; x < part.width; x++) {
            const short share = shares[x / tile];
            const int sample = samples[x] << 7, mean = means[x];
            const int average = mean + ((sample - mean) * share + 16384 >> 15);
            const int next = share == NEW_SCENE ? sample : share == HELD ? mean : average;
            means[x] = (short)next;
            samples[x] = (uchar)((share == HELD ? sample : next) + 64 >> 7);
        }
    }
}

/* Of each component: its rows, means and size. */
#define PLANES_OF(c)                                                                                                   \
    __global const ulong2 *rows##c, __global short *means##c, int2 size##c,
#define PART(c)                                                                                                        \
    ((Part){stack + rows##c[z].x, rows##c[z].y, means##c + (long)z * size##c.x * size##c.y, size##c.x, size##c.y})
#if COMPONENTS == 3
#define EACH(work) work(0) work(1) work(2)
#elif COMPONENTS == 2
#define EACH(work) work(0) work(1)
#else
#define EACH(work) work(0)
#endif

/* tilesC[i][tile]: of rows 0, step, 2 step ... of the tiles of plane z, for the host to learn the noise from. Work-items
 * (rows). */
#define TILES_OF(c) __global float4 *tiles##c,
__kernel void measure_rows(__global uchar *stack, EACH(PLANES_OF) EACH(TILES_OF) int2 count, int z, int step)
{
    const int i = (int)get_group_id(0);
#define MEASURE(c) measure_row(PART(c), TILE##c, ROWS##c, i * step, count.x, tiles##c + (long)i * count.x);
    EACH(MEASURE)
}

/* A row of tiles in all planes and components, into moved[][tile]. most[c][brightness], of_sweeps[k]. */
#define JUDGE(c)                                                                                                       \
    judge_row(PART(c), TILE##c, ROWS##c, ty, count.x, sweeps + tiles, held + tiles, most + c * BRIGHTNESSES,           \
              of_sweeps, least, moved + row);
#define JUDGE_ROW                                                                                                      \
    const long row = (long)ty * count.x;                                                                               \
    for (int tx = 0; tx < count.x; tx++)                                                                               \
        moved[row + tx] = 0;                                                                                           \
    for (int z = 0; z < planes; z++) {                                                                                 \
        const long tiles = ((long)z * count.y + ty) * count.x;                                                         \
        if (!(wanted >> z & 1))                                                                                        \
            continue;                                                                                                  \
        EACH(JUDGE)                                                                                                    \
    }

/* The first and the last row of tiles of each strip. Work-items (strips). */
__kernel void judge_borders(__global uchar *stack, EACH(PLANES_OF) __global const uchar *sweeps,
                            __global const float2 *most, __global const float2 *of_sweeps, __global uchar *moved,
                            __global const uchar *held, int2 count, int planes, int strip, float least, ulong wanted)
{
    const int first = (int)get_group_id(0) * strip, last = min(first + strip, count.y) - 1;
    for (int ty = first; ty <= last; ty += max(last - first, 1)) {
        JUDGE_ROW
    }
}

/* of_shares[k] is that of the mean of k sweeps. near[work-item][tile]; parts[work-item][part_stride], the shares of a row of
 * tiles and then of its samples; the rest as above. */
__kernel void denoise_strips(__global uchar *stack, EACH(PLANES_OF) __global uchar *sweeps, __global const float2 *most,
                             __global const float2 *of_sweeps, __global const short *of_shares, __global uchar *moved,
                             __global uchar *near, __global short *parts, int part_stride, __global const uchar *held,
                             int2 count, int planes, int strip, float least, int frames, ulong wanted, ulong absent)
{
    const int first = (int)get_group_id(0) * strip, end = min(first + strip, count.y);
    __global short *shares = parts + (long)get_group_id(0) * part_stride;
    near += (long)get_group_id(0) * count.x;
    parts = shares + SHARES(count.x);
    for (int above = first; above < end; above++) {
        const int ty = above + 1;
        if (ty < end - 1) {
            JUDGE_ROW
        }
        look_around(moved, above, count, near);
        for (int z = 0; z < planes; z++) {
            const long tiles = ((long)z * count.y + above) * count.x;
            if (absent >> z & 1)
                continue;
            const int is_special = count_row(near, held + tiles, of_shares, count.x, frames, (int)(wanted >> z & 1),
                                             sweeps + tiles, shares);
#define AVERAGE(c) average_row(PART(c), TILE##c, ROWS##c, above, count.x, shares, 1, parts);
#define AVERAGE_PLAINLY(c) average_row(PART(c), TILE##c, ROWS##c, above, count.x, shares, 0, parts);
            if (is_special) {
                EACH(AVERAGE)
            } else {
                EACH(AVERAGE_PLAINLY)
            }
        }
    }
}
