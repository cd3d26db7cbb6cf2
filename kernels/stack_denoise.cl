/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Each plane averaged with the same plane of the sweeps before, tile by tile of 8x8 pixels, as long as nothing moved there:
 *
 *     k <- 1 where the tile or one around it moved in any plane, else min(k + 1, frames)      m <- m + (x - m) / k      x <- m
 *
 * with m the mean of k sweeps. Where a tile is `held`, k, m and x stay as they are: something passes there, and what is
 * behind it is not forgotten. A tile moved where the mean or the mean square of x - m is more than noise makes it. Noise
 * has the variance v (1 + 1/k), v by a curve over brightness; its neighbouring samples may be alike (demosaicing, JPEG),
 * which makes the tile's mean `spread` times less certain than n samples would.
 *
 * A component of the picture (luma, chroma, interleaved colours) is seen as rows of samples; a tile has LANES CHUNKS samples
 * in each of ROWS rows. Tiles at the right and lower borders may be cut off. Samples are in their own units, of SAMPLE_BYTES
 * bytes. Planes whose bit is not set in `wanted` have nothing new to tell and get the mean; those of `absent` stay as they are.
 * rows[z] is where the component's plane z lies: byte of its first row, bytes a row.
 */
#define JOIN(a, b) a##b
#define LANES_OF(type, lanes) JOIN(type, lanes)
#define TILE (LANES * CHUNKS)
#define CURVE 16 /* brightnesses */

#if SAMPLE_BYTES == 2
typedef ushort sample_t;
typedef float mean_t;
#define MEAN_UNIT 1.0f
#define WHITE 65536.0f
#else
typedef uchar sample_t;
typedef ushort mean_t; /* in 1/128 */
#define MEAN_UNIT 128.0f
#define WHITE 256.0f
#endif

typedef LANES_OF(float, LANES) flanes_t;
#define LOAD(p) LANES_OF(convert_float, LANES)(LANES_OF(vload, LANES)(0, p))
#if SAMPLE_BYTES == 2
#define TO_MEAN(v) (v)
#define TO_SAMPLE(v) LANES_OF(convert_ushort, LANES)(v)
#else
#define TO_MEAN(v) LANES_OF(convert_ushort, LANES)((v) * MEAN_UNIT + 0.5f)
#define TO_SAMPLE(v) LANES_OF(convert_uchar, LANES)(v)
#endif
#define STORE(v, p) LANES_OF(vstore, LANES)(v, 0, p)

inline float sum_of(flanes_t v)
{
#if LANES == 8
    const float4 half_sum = v.lo + v.hi;
#else
    const float4 half_sum = v;
#endif
    const float2 quarter_sum = half_sum.lo + half_sum.hi;
    return quarter_sum.x + quarter_sum.y;
}

inline __global sample_t *row_of(__global uchar *stack, ulong2 rows, int y)
{
    return (__global sample_t *)(stack + rows.x + rows.y * (ulong)y);
}

/* tiles[z][tile]: mean and mean square of x - m over the tile, and its mean brightness. A tile that is cut off reaches back
 * over the one before. Work-items (runs, tiles down, planes), each over `run` tiles. */
__kernel void measure_tiles(__global uchar *stack, __global const ulong2 *rows, __global const mean_t *means,
                            __global float4 *tiles, int width, int height, int2 count, int run)
{
    const int ty = (int)get_global_id(1), z = (int)get_global_id(2);
    const int first = (int)get_global_id(0) * run, end = min(first + run, count.x);
    const int y0 = min(ty * ROWS, height - ROWS);
    for (int tx = first; tx < end; tx++) {
        const int x0 = min(tx * TILE, width - TILE);
        flanes_t sum = 0.0f, squares = 0.0f, brightness = 0.0f;
        for (int y = y0; y < y0 + ROWS; y++) {
            __global const sample_t *samples = row_of(stack, rows[z], y) + x0;
            __global const mean_t *mean = means + ((long)z * height + y) * width + x0;
            for (int i = 0; i < CHUNKS; i++) {
                const flanes_t m = LOAD(mean + i * LANES) * (1.0f / MEAN_UNIT);
                const flanes_t d = LOAD(samples + i * LANES) - m;
                sum += d;
                squares += d * d;
                brightness += m;
            }
        }
        const float n = TILE * ROWS;
        tiles[((long)z * count.y + ty) * count.x + tx] =
            (float4)(sum_of(sum) / n, sum_of(squares) / n, sum_of(brightness) / n, 0.0f);
    }
}

/* Of the variance that a tile of this brightness has by noise. */
inline float variance_at(__global const float *curve, float brightness)
{
    const float place = clamp(brightness * (CURVE / WHITE) - 0.5f, 0.0f, CURVE - 1.0f);
    const int i = min((int)place, CURVE - 2);
    return mix(curve[i], curve[i + 1], place - i);
}

/* Adds to moved[z][tile], which the first component writes anew (`is_first`), where this component's tiles moved. `least` is
 * what is never called motion; noise takes a tile's mean by `most_mean` standard deviations of a sample and its mean square to
 * `most_square` times the variance. */
__kernel void judge_tiles(__global const float4 *tiles, __global const uchar *sweeps, __global const float *curve,
                          __global uchar *moved, int2 count, float most_mean, float most_square, float least,
                          int is_first)
{
    const int tx = (int)get_global_id(0), ty = (int)get_global_id(1), z = (int)get_global_id(2);
    if (tx >= count.x)
        return;
    const long i = ((long)z * count.y + ty) * count.x + tx;
    const float4 tile = tiles[i];
    const float variance = variance_at(curve, tile.z) * (1.0f + 1.0f / max((float)sweeps[i], 1.0f));
    const uchar is_far = fabs(tile.x) > most_mean * sqrt(variance) + least || tile.y > most_square * variance + least;
    const uchar is_moved = is_far && sweeps[i] > 0; /* what was never seen did not move */
    moved[i] = is_first ? is_moved : moved[i] | is_moved;
}

/* sweeps[z][tile] becomes k of what average_tiles() does next: by the tiles around that moved and are not held, in any
 * plane: planes that are not denoised alike would pass for differently sharp. frames >= 1. */
__kernel void count_sweeps(__global const uchar *moved, __global const uchar *held, __global uchar *sweeps, int2 count, int frames,
                           ulong wanted)
{
    const int tx = (int)get_global_id(0), ty = (int)get_global_id(1), z = (int)get_global_id(2);
    if (tx >= count.x || !(wanted >> z & 1) || held[((long)z * count.y + ty) * count.x + tx])
        return;
    int is_moved = 0;
    for (int other = 0; other < (int)get_global_size(2); other++)
        for (int y = max(ty - 1, 0); y <= min(ty + 1, count.y - 1); y++)
            for (int x = max(tx - 1, 0); x <= min(tx + 1, count.x - 1); x++) {
                const long at = ((long)other * count.y + y) * count.x + x;
                is_moved |= wanted >> other & 1 && moved[at] && !held[at];
            }
    const long i = ((long)z * count.y + ty) * count.x + tx;
    sweeps[i] = is_moved ? 1 : min(sweeps[i] + 1, frames); /* 0 before the first sweep */
}

/* Work-items as of measure_tiles(). */
__kernel void average_tiles(__global uchar *stack, __global const ulong2 *rows, __global mean_t *means,
                            __global const uchar *held, __global const uchar *sweeps, int width, int height, int2 count,
                            int run, ulong wanted, ulong absent)
{
    const int ty = (int)get_global_id(1), z = (int)get_global_id(2);
    if (absent >> z & 1)
        return;
    const int first = (int)get_global_id(0) * run, end = min(first + run, count.x);
    for (int tx = first; tx < end; tx++) {
        if (held[((long)z * count.y + ty) * count.x + tx])
            continue;
        const float part =
            wanted >> z & 1 ? 1.0f / (float)sweeps[((long)z * count.y + ty) * count.x + tx] : 0.0f;
        for (int y = ty * ROWS; y < min(ty * ROWS + ROWS, height); y++) {
            __global sample_t *samples = row_of(stack, rows[z], y);
            __global mean_t *mean = means + ((long)z * height + y) * width;
            const int end_x = min(tx * TILE + TILE, width);
            int x = tx * TILE;
            for (; x + LANES <= end_x; x += LANES) {
                const flanes_t m = LOAD(mean + x) * (1.0f / MEAN_UNIT);
                const flanes_t average = m + (LOAD(samples + x) - m) * part;
                STORE(TO_MEAN(average), mean + x);
                STORE(TO_SAMPLE(average + 0.5f), samples + x);
            }
            for (; x < end_x; x++) {
                const float m = (float)mean[x] * (1.0f / MEAN_UNIT);
                const float average = m + ((float)samples[x] - m) * part;
                mean[x] = (mean_t)(SAMPLE_BYTES == 2 ? average : average * MEAN_UNIT + 0.5f);
                samples[x] = (sample_t)(average + 0.5f);
            }
        }
    }
}
