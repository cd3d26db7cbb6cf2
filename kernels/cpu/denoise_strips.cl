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
#define AHEAD 192 /* samples that are asked for early */
#define NEW_SCENE ((short)-1) /* a part: the mean begins anew with this sample */
#define HELD ((short)-2)      /* a part: the mean stays, and the sample too */

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

/* out[tile] of one row of tiles, as tiles[] of stack_denoise.cl. */
INLINE void measure_row(Part part, const int tile, const int rows, int ty, int count, __global float4 *out)
{
    const int y0 = min(ty * rows, part.height - rows);
    const int block = tile == 24 ? 96 : 32; /* whole vectors and whole tiles */
    const int whole = part.width / block;
    const float n = tile * rows;
    for (int b = 0; b < whole; b++) {
        int sums[48], squares[48], lights[48]; /* of pairs of columns */
        for (int v = 0; v < block / 32; v++) {
            short32 sum = 0, light = 0;
            int16 square = 0;
            for (int y = 0; y < rows; y++) {
                const int x = b * block + 32 * v;
                __global const short *means = part.means + (long)(y0 + y) * part.width + x;
                __global const uchar *samples = part.samples + (ulong)(y0 + y) * part.stride + x;
                PREFETCH(means + AHEAD);
                PREFETCH(samples + AHEAD);
                const short32 mean = *(__global const slanes32 *)means, sample = load_samples(samples);
                const short32 difference = (sample - mean + (short)4) >> (short)3;
                sum += difference;
                square += product_of_pairs(difference, difference);
                light += mean >> (short)3;
            }
            *(ilanes *)(sums + 16 * v) = product_of_pairs(sum, (short32)1);
            *(ilanes *)(squares + 16 * v) = square;
            *(ilanes *)(lights + 16 * v) = product_of_pairs(light, (short32)1);
        }
        for (int t = 0; t < block / tile; t++) {
            int sum = 0, light = 0;
            float square = 0.0f;
            for (int i = t * tile / 2; i < (t + 1) * tile / 2; i++) {
                sum += sums[i];
                light += lights[i];
                square += (float)squares[i];
            }
            out[b * (block / tile) + t] =
                (float4)(sum / (16.0f * n), square / (256.0f * n), light / (16.0f * n), 0.0f);
        }
    }
    for (int tx = whole * (block / tile); tx < count; tx++) {
        const int x0 = min(tx * tile, part.width - tile);
        float sum = 0.0f, square = 0.0f, light = 0.0f;
        for (int y = y0; y < y0 + rows; y++)
            for (int x = x0; x < x0 + tile; x++) {
                const float mean = part.means[(long)y * part.width + x] / 128.0f;
                const float difference = part.samples[(ulong)y * part.stride + x] - mean;
                sum += difference;
                square += difference * difference;
                light += mean;
            }
        out[tx] = (float4)(sum / n, square / n, light / n, 0.0f);
    }
}

/* Adds to moved[] which tiles of a row moved and are not held. most[brightness]: how far a tile's mean, and its mean square,
 * may be off by noise of one sweep; of_sweeps[k]: by how much more where the mean of k sweeps is compared, for either. */
INLINE void judge_row(__global const float4 *tiles, __global const uchar *sweeps, __global const uchar *held,
                      __global const float2 *most, __global const float2 *of_sweeps, float least, int count,
                      __global uchar *moved)
{
    for (int tx = 0; tx < count; tx++) {
        const float4 tile = tiles[tx];
        const float2 bound = most[clamp((int)tile.z, 0, BRIGHTNESSES - 1)] * of_sweeps[sweeps[tx]] + least;
        moved[tx] |= (fabs(tile.x) > bound.x || tile.y > bound.y) && !held[tx];
    }
}

/* sweeps[tile] of a row of tiles becomes k: stack_denoise.cl's count_sweeps(). */
INLINE void count_row(__global const uchar *moved, __global const uchar *held, __global uchar *sweeps, int ty,
                      int2 count, int frames)
{
    __global const uchar *above = moved + (long)max(ty - 1, 0) * count.x, *here = moved + (long)ty * count.x;
    __global const uchar *below = moved + (long)min(ty + 1, count.y - 1) * count.x;
    uchar left = 0, middle = above[0] | here[0] | below[0];
    for (int tx = 0; tx < count.x; tx++) {
        const uchar right = tx + 1 < count.x ? above[tx + 1] | here[tx + 1] | below[tx + 1] : 0;
        if (!held[tx])
            sweeps[tx] = left | middle | right ? 1 : min(sweeps[tx] + 1, frames);
        left = middle;
        middle = right;
    }
}

/* A row of tiles. parts[] is room for a row of samples. Where nothing is `wanted`, the samples become the mean. */
INLINE void average_row(Part part, const int tile, const int rows, int ty, int count, __global const uchar *held,
                        __global const uchar *sweeps, int is_wanted, __global short *parts)
{
    for (int tx = 0; tx < count; tx++) {
        const int k = sweeps[tx];
        const short share = held[tx] ? HELD : !is_wanted ? 0 : k == 1 ? NEW_SCENE : (short)((32768 + k / 2) / k);
        for (int x = tx * tile; x < tx * tile + tile; x += 4)
            vstore4((short4)share, 0, parts + x);
    }
    const int whole = part.width / 32 * 32;
    for (int y = ty * rows; y < min(ty * rows + rows, part.height); y++) {
        __global short *means = part.means + (long)y * part.width;
        __global uchar *samples = part.samples + (ulong)y * part.stride;
        for (int x = 0; x < whole; x += 32) {
            const short32 sample = load_samples(samples + x), mean = *(__global const slanes32 *)(means + x);
            const short32 share = *(__global const slanes32 *)(parts + x);
            const short32 average = mean + rounded_part_of(sample - mean, share);
            const short32 next = share == NEW_SCENE ? sample : share == HELD ? mean : average;
            const short32 shown = share == HELD ? sample : next;
            *(__global slanes32 *)(means + x) = next;
            *(__global bytes32 *)(samples + x) = __builtin_convertvector((shown + (short)64) >> (short)7, uchar32);
        }
        for (int x = whole; x < part.width; x++) {
            const int sample = samples[x] << 7, mean = means[x];
            const int average = mean + ((sample - mean) * parts[x] + 16384 >> 15);
            const int next = parts[x] == NEW_SCENE ? sample : parts[x] == HELD ? mean : average;
            means[x] = (short)next;
            samples[x] = (uchar)((parts[x] == HELD ? sample : next) + 64 >> 7);
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
    measure_row(PART(c), TILE##c, ROWS##c, ty, count.x, scratch);                                                      \
    judge_row(scratch, sweeps + tiles, held + tiles, most + c * BRIGHTNESSES, of_sweeps, least, count.x, moved + row);
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

/* The first and the last row of tiles of each strip. scratch[work-item][tile]; work-items (strips). */
__kernel void judge_borders(__global uchar *stack, EACH(PLANES_OF) __global const uchar *sweeps,
                            __global const float2 *most, __global const float2 *of_sweeps, __global uchar *moved,
                            __global float4 *scratch, __global const uchar *held, int2 count, int planes, int strip,
                            float least, ulong wanted)
{
    const int first = (int)get_group_id(0) * strip, last = min(first + strip, count.y) - 1;
    scratch += (long)get_group_id(0) * count.x;
    for (int ty = first; ty <= last; ty += max(last - first, 1)) {
        JUDGE_ROW
    }
}

/* parts[work-item][part_stride]; the rest as above. */
__kernel void denoise_strips(__global uchar *stack, EACH(PLANES_OF) __global uchar *sweeps, __global const float2 *most,
                             __global const float2 *of_sweeps, __global uchar *moved, __global float4 *scratch,
                             __global short *parts, int part_stride, __global const uchar *held, int2 count, int planes,
                             int strip, float least, int frames, ulong wanted, ulong absent)
{
    const int first = (int)get_group_id(0) * strip, end = min(first + strip, count.y);
    scratch += (long)get_group_id(0) * count.x;
    parts += (long)get_group_id(0) * part_stride;
    for (int above = first; above < end; above++) {
        const int ty = above + 1;
        if (ty < end - 1) {
            JUDGE_ROW
        }
        for (int z = 0; z < planes; z++) {
            const long tiles = ((long)z * count.y + above) * count.x;
            const int is_wanted = wanted >> z & 1;
            if (absent >> z & 1)
                continue;
            if (is_wanted)
                count_row(moved, held + tiles, sweeps + tiles, above, count, frames);
#define AVERAGE(c)                                                                                                     \
    average_row(PART(c), TILE##c, ROWS##c, above, count.x, held + tiles, sweeps + tiles, is_wanted, parts);
            EACH(AVERAGE)
        }
    }
}
