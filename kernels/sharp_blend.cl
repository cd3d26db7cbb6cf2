/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * All-in-focus picture blended in bands of detail (a Laplacian pyramid: Burt and Adelson, ACM Trans. Graph. 2, 1983),
 * so that a switch from plane to plane is as wide as the detail that it switches and draws no line. With G_l,z the plane
 * at level l (pyramid_rows.cl), shrunk by 1 3 3 1 in both directions, the weights of sharp_weights.cl, and "up" the way
 * back from level l + 1,
 *
 *     R_L = sum_z w_z G_L,z / sum_z w_z,   R_l = up(R_l+1) + sum_z w_z (G_l,z - up(G_l+1,z)) / sum_z w_z,
 *
 * R_0 the picture. One component of the stack at a time, CHANNELS interleaved samples a pixel, each with volumes of its
 * own: [channel][plane]. A component subsampled by 2 begins at level 1. Samples are SAMPLE, uchar or ushort; G has 16
 * bits of them, R is in the same unit.
 */
#include "pyramid_rows.cl"

#if SAMPLE_BYTES == 2
#define SAMPLE ushort
#define samples16 ushort16
#define sums16 uint16
#define CONVERT_SUMS convert_uint16
#define TO_SAMPLES convert_ushort16
#define LANES lanes16
#define MOST 65535.0f
#define ONE 1 /* of a sample in G */
#define SUMS_TO_G(v) convert_ushort16((v + 32u) >> 6u)
#else
#define SAMPLE uchar
#define samples16 uchar16
#define sums16 ushort16
#define CONVERT_SUMS convert_ushort16
#define TO_SAMPLES convert_uchar16
#define LANES lanes8
#define MOST 255.0f
#define ONE 256
#define SUMS_TO_G(v) (v << (ushort16)2)
#endif

/* The channels of 16 pixels from x on, which may lie outside: there stand the row's ends. */
INLINE void load_pixels(__global const SAMPLE *row, int x, int width, samples16 *channels)
{
    if (x < 0 || x + 16 > width) {
        SAMPLE cells[CHANNELS][16];
        for (int i = 0; i < 16; i++)
            for (int k = 0; k < CHANNELS; k++)
                cells[k][i] = row[clamp(x + i, 0, width - 1) * CHANNELS + k];
        for (int k = 0; k < CHANNELS; k++)
            channels[k] = vload16(0, cells[k]);
        return;
    }
    __global const LANES *lanes = (__global const LANES *)(row + x * CHANNELS);
    const samples16 a = lanes[0];
#if CHANNELS == 1
    channels[0] = a;
#elif CHANNELS == 2
    const samples16 b = lanes[1];
    channels[0] = (samples16)(a.even, b.even);
    channels[1] = (samples16)(a.odd, b.odd);
#elif CHANNELS == 3
    const samples16 b = lanes[1], c = lanes[2];
    channels[0] = (samples16)(a.s0369, a.scf, b.s258, b.sbe, c.s147, c.sad);
    channels[1] = (samples16)(a.s147a, a.sd, b.s0369, b.scf, c.s258b, c.se);
    channels[2] = (samples16)(a.s258b, a.se, b.s147a, b.sd, c.s0369, c.scf);
#else
    const samples16 b = lanes[1], c = lanes[2], d = lanes[3];
    for (int k = 0; k < 2; k++) {
        const samples16 even = k ? (samples16)(a.odd, b.odd) : (samples16)(a.even, b.even);
        const samples16 odd = k ? (samples16)(c.odd, d.odd) : (samples16)(c.even, d.even);
        channels[k] = (samples16)(even.even, odd.even);
        channels[k + 2] = (samples16)(even.odd, odd.odd);
    }
#endif
}

/* 1 3 3 1 along the 34 cells of three vectors, the first before the first that the result stands for. */
#define SHRINK_ALONG(vector)                                                                                           \
    INLINE vector __attribute__((overloadable)) shrink_along(vector first, vector second, vector third)                \
    {                                                                                                                  \
        const vector a = (vector)(first.even, second.even), b = (vector)(first.odd, second.odd);                       \
        const vector c = (vector)(a.s1234, a.s5678, a.s9abc, a.sdef, third.s0);                                        \
        const vector d = (vector)(b.s1234, b.s5678, b.s9abc, b.sdef, third.s1);                                        \
        return a + (b + c) * (vector)3 + d;                                                                            \
    }
SHRINK_ALONG(ushort16)
SHRINK_ALONG(uint16)

/* G of the first level of a component: work-items (16 cells, row, plane). */
__kernel void shrink_samples(__global const uchar *stack, __global const ulong2 *table, int first_row, int2 size,
                             __global ushort *volume, Level level, int planes)
{
    const int x = (int)get_global_id(0) * 16, y = (int)get_global_id(1), z = (int)get_global_id(2);
    if (x >= level.width)
        return;
    const ulong2 rows = table[first_row + z];
    sums16 sums[3][CHANNELS];
    for (int part = 0; part < 3; part++) {
        samples16 lines[4][CHANNELS];
        for (int i = 0; i < 4; i++) {
            const ulong line = (ulong)clamp(2 * y - 1 + i, 0, size.y - 1);
            load_pixels((__global const SAMPLE *)(stack + rows.x + rows.y * line), 2 * x - 1 + 16 * part, size.x, lines[i]);
        }
        for (int k = 0; k < CHANNELS; k++)
            sums[part][k] = CONVERT_SUMS(lines[0][k]) + CONVERT_SUMS(lines[3][k]) +
                            (CONVERT_SUMS(lines[1][k]) + CONVERT_SUMS(lines[2][k])) * (sums16)3;
    }
    for (int k = 0; k < CHANNELS; k++)
        store_cells(volume + row_of(level, k * planes + z, y), x, level.width,
                    SUMS_TO_G(shrink_along(sums[0][k], sums[1][k], sums[2][k])));
}

/* G of the next level: work-items (16 cells, row, picture). */
__kernel void shrink(__global const ushort *volume, Level level, __global ushort *result, Level coarse)
{
    const int x = (int)get_global_id(0) * 16, y = (int)get_global_id(1), picture = (int)get_global_id(2);
    if (x >= coarse.width)
        return;
    uint16 sums[3];
    for (int part = 0; part < 3; part++) {
        uint16 lines[4];
        for (int i = 0; i < 4; i++)
            lines[i] = convert_uint16(*(__global const lanes16 *)(volume + row_of(level, picture, 2 * y - 1 + i) + 2 * x -
                                                                  1 + 16 * part));
        sums[part] = lines[0] + (lines[1] + lines[2]) * (uint16)3 + lines[3];
    }
    store_cells(result + row_of(coarse, picture, y), x, coarse.width,
                convert_ushort16((shrink_along(sums[0], sums[1], sums[2]) + 32u) >> 6u));
}

INLINE int is_nothing(uchar16 weights)
{
    const ulong2 parts = as_ulong2(weights);
    return (parts.s0 | parts.s1) == 0;
}

/* R of the highest level: work-items (16 cells, row, channel). */
__kernel void blend_top(__global const ushort *volume, __global const uchar *weights, Level level, int planes,
                        __global float *result)
{
    const int x = (int)get_global_id(0) * 16, y = (int)get_global_id(1), channel = (int)get_global_id(2);
    if (x >= level.width)
        return;
    float16 sum = 0.0f, total = 0.0f;
    for (int z = 0; z < planes; z++) {
        const float16 weight = convert_float16(*(__global const lanes8 *)(weights + row_of(level, z, y) + x));
        sum += weight * convert_float16(*(__global const lanes16 *)(volume + row_of(level, channel * planes + z, y) + x));
        total += weight;
    }
    store_cells(result + row_of(level, channel, y), x, level.width, sum / total);
}

/* R of a level between: work-items (16 cells, row, channel). */
__kernel void blend(__global const ushort *volume, __global const uchar *weights, Level level,
                    __global const ushort *coarse_volume, __global const float *coarse_result, Level coarse, int planes,
                    __global float *result)
{
    const int x = (int)get_global_id(0) * 16, y = (int)get_global_id(1), channel = (int)get_global_id(2);
    if (x >= level.width)
        return;
    float16 sum = 0.0f, total = 0.0f;
    for (int z = 0; z < planes; z++) {
        const uchar16 share = *(__global const lanes8 *)(weights + row_of(level, z, y) + x);
        if (is_nothing(share))
            continue;
        const int picture = channel * planes + z;
        const float16 weight = convert_float16(share);
        const float16 here = convert_float16(*(__global const lanes16 *)(volume + row_of(level, picture, y) + x));
        sum += weight * (here - upsampled(coarse_volume, coarse_rows(coarse, picture, x, y)));
        total += weight;
    }
    store_cells(result + row_of(level, channel, y), x, level.width,
                sum / total + upsampled(coarse_result, coarse_rows(coarse, channel, x, y)));
}

/* The weights of 16 samples in plane z: the cells of level 1 are those of a component that is subsampled. */
INLINE float16 weights_of_samples(__global const uchar *weights, Level level, int z, int x, int y, int subsampling)
{
    return subsampling == 1 ? upsampled(weights, coarse_rows(level, z, x, y))
                            : convert_float16(*(__global const lanes8 *)(weights + row_of(level, z, y) + x));
}

/* R_0 of one component: work-items (16 pixels of it, row). `weight_level` is level 1, `coarse` the component's
 * second. */
__kernel void blend_samples(__global const uchar *stack, __global const ulong2 *table, int first_row, int2 size,
                            __global const uchar *weights, Level weight_level, int subsampling,
                            __global const ushort *coarse_volume, __global const float *coarse_result, Level coarse,
                            int planes, __global uchar *picture, ulong2 picture_rows)
{
    const int x = (int)get_global_id(0) * 16, y = (int)get_global_id(1);
    if (x >= size.x)
        return;
    float16 sums[CHANNELS], total = 0.0f;
    for (int k = 0; k < CHANNELS; k++)
        sums[k] = 0.0f;
    for (int z = 0; z < planes; z++) {
        const float16 weight = weights_of_samples(weights, weight_level, z, x, y, subsampling);
        if (!any(weight.lo + weight.hi > 0.0f))
            continue;
        const ulong2 rows = table[first_row + z];
        samples16 samples[CHANNELS];
        load_pixels((__global const SAMPLE *)(stack + rows.x + rows.y * (ulong)y), x, size.x, samples);
        for (int k = 0; k < CHANNELS; k++)
            sums[k] += weight * (convert_float16(samples[k]) * ONE -
                                 upsampled(coarse_volume, coarse_rows(coarse, k * planes + z, x, y)));
        total += weight;
    }
    __global SAMPLE *out = (__global SAMPLE *)(picture + picture_rows.x + picture_rows.y * (ulong)y) + x * CHANNELS;
    SAMPLE samples[CHANNELS][16];
    for (int k = 0; k < CHANNELS; k++) {
        const float16 value = sums[k] / total + upsampled(coarse_result, coarse_rows(coarse, k, x, y));
        vstore16(TO_SAMPLES(clamp(value / ONE + 0.5f, (float16)0.0f, (float16)MOST)), 0, samples[k]);
    }
    for (int i = 0; i < min(16, size.x - x); i++)
        for (int k = 0; k < CHANNELS; k++)
            out[i * CHANNELS + k] = samples[k][i];
}
