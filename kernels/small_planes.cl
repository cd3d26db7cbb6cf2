/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The planes of a stack area-downsampled to 1/SCALE, in R, G, B: low pictures short small[z][colour].
 *
 * YUV becomes RGB by BT.601 in 1/32, full range: the colours only have to part surfaces.
 */
#include "low_picture.cl"

typedef uchar16 uchar16_anywhere __attribute__((aligned(1)));

INLINE ushort16 add_pairs(ushort16 a, ushort16 b)
{
    return (ushort16)(a.even + a.odd, b.even + b.odd);
}

/* Sums of each `box` of 16 * box neighbours. */
INLINE ushort16 sum_along(ushort16 *sums, const int box)
{
    UNROLL
    for (int count = box; count > 1; count /= 2)
        UNROLL
        for (int i = 0; i < count / 2; i++)
            sums[i] = add_pairs(sums[2 * i], sums[2 * i + 1]);
    return sums[0];
}

/* Sums over `box` rows of 16 samples. */
INLINE ushort16 sum_rows(__global const uchar *top, ulong stride, const int box)
{
    ushort16 sum = 0;
    UNROLL
    for (int j = 0; j < box; j++)
        sum += convert_ushort16(*(__global const uchar16_anywhere *)(top + stride * (ulong)j));
    return sum;
}

/* 16 averages of squares of `box` samples, times `one`. */
INLINE short16 average(__global const uchar *top, ulong stride, const int box, const int one)
{
    ushort16 sums[8];
    UNROLL
    for (int i = 0; i < box; i++)
        sums[i] = sum_rows(top + 16 * i, stride, box);
    const ushort16 sum = sum_along(sums, box);
    return as_short16(one >= box * box ? sum * (ushort)(one / (box * box)) : sum / (ushort)(box * box / one));
}

/* The same of two interleaved components. */
INLINE void average_both(__global const uchar *top, ulong stride, const int box, const int one, short16 *first,
                         short16 *second)
{
    ushort16 firsts[8], seconds[8];
    UNROLL
    for (int i = 0; i < box; i++) {
        const ushort16 left = sum_rows(top + 32 * i, stride, box), right = sum_rows(top + 32 * i + 16, stride, box);
        firsts[i] = (ushort16)(left.even, right.even);
        seconds[i] = (ushort16)(left.odd, right.odd);
    }
    const ushort factor = (ushort)max(one / (box * box), 1), divisor = (ushort)max(box * box / one, 1);
    *first = as_short16(sum_along(firsts, box) * factor / divisor);
    *second = as_short16(sum_along(seconds, box) * factor / divisor);
}

#if LUMA_BYTES == 2
typedef uint sum_t;
typedef uint16 sums_t;
#define ADD_SAMPLES(row) convert_uint16(*(__global const lanes16 *)(row))
/* Of a sum over SCALE x SCALE samples: no product needs more than 32 bits. */
#define TO_COLOUR(sum) ((sum) / (SCALE * SCALE) * COLOUR_ONE / 257)
#else
typedef ushort sum_t;
typedef ushort16 sums_t;
#define ADD_SAMPLES(row) convert_ushort16(*(__global const uchar16_anywhere *)(row))
#define TO_COLOUR(sum) ((sum) * COLOUR_ONE / (SCALE * SCALE))
#endif

/* The average of a square of any samples, `step` bytes apart. */
INLINE short average_any(__global const uchar *top, ulong stride, int step, const int box, int one)
{
    uint sum = 0;
    UNROLL
    for (int j = 0; j < box; j++)
        for (int k = 0; k < box; k++)
#if LUMA_BYTES == 2
            sum += top[stride * (ulong)j + k * step] | (uint)top[stride * (ulong)j + k * step + 1] << 8;
    return (short)(sum / (uint)(box * box) * (uint)one * 255 / 65535);
#else
            sum += top[stride * (ulong)j + k * step];
    return (short)(sum * one / (uint)(box * box));
#endif
}

#define CHROMA_ONE 4

#if defined(CHROMA)
/* y in 1/COLOUR_ONE, u and v in 1/CHROMA_ONE; products fit 16 bits. */
#define STORE_YUV(y, u, v, SHORT, STORE)                                                                               \
    {                                                                                                                  \
        const SHORT blue = (u) - (SHORT)(128 * CHROMA_ONE), red = (v) - (SHORT)(128 * CHROMA_ONE);                     \
        STORE(out) = (y) + ((red * (SHORT)45) >> (SHORT)3);                                                              \
        STORE(out + colour) = (y) - ((blue * (SHORT)11 + red * (SHORT)23) >> (SHORT)3);                                  \
        STORE(out + 2 * colour) = (y) + ((blue * (SHORT)57) >> (SHORT)3);                                                \
    }
#define ONE_SHORT(pointer) *(pointer)
#endif

/* `channels`: of interleaved colours samples a pixel and index of R, G, B; of NV12 and I420 step and index of U, of V.
 * Planes whose bit of `wanted` is not set stay as they are. Work-items (1, low height, planes). */
__kernel void average_colours(__global const uchar *stack, __global const ulong2 *rows, int4 channels, ulong wanted,
                              __global short *small, int low_width, int stride)
{
    const int low_y = (int)get_global_id(1), z = (int)get_global_id(2), low_height = (int)get_global_size(1);
    if (!(wanted >> z & 1))
        return;
    const size_t colour = (size_t)low_height * stride;
    __global short *row = small + ((size_t)(3 * z) * low_height + low_y) * stride + SIDE;
    __global const uchar *top = stack + rows[z].x + rows[z].y * (ulong)(low_y * SCALE);
    const ulong step = rows[z].y;

#if defined(CHROMA)
    const int planes = (int)get_global_size(2);
    const ulong2 u_rows = rows[planes + z], v_rows = rows[V_COMPONENT * planes + z];
    const ulong chroma_y = low_y * (SCALE / 2);
    __global const uchar *u_top = stack + u_rows.x + u_rows.y * chroma_y, *v_top = stack + v_rows.x + v_rows.y * chroma_y;
    for (int done = 0; done + 16 <= low_width || done < low_width; done += 16) {
        if (low_width < 16) {
            for (int x = 0; x < low_width; x++) {
                __global short *out = row + x;
                const int chroma_x = x * (SCALE / 2);
                const short y = average_any(top + x * SCALE, step, 1, SCALE, COLOUR_ONE);
                const short u = average_any(u_top + chroma_x * channels.s0 + channels.s1, u_rows.y, channels.s0, SCALE / 2,
                                            CHROMA_ONE);
                const short v = average_any(v_top + chroma_x * channels.s2 + channels.s3, v_rows.y, channels.s2, SCALE / 2,
                                            CHROMA_ONE);
                STORE_YUV(y, u, v, short, ONE_SHORT)
            }
            return;
        }
        const int x = min(done, low_width - 16);
        __global short *out = row + x;
        const short16 y = average(top + x * SCALE, step, SCALE, COLOUR_ONE);
        short16 u, v;
#if V_COMPONENT == 2
        u = average(u_top + x * (SCALE / 2), u_rows.y, SCALE / 2, CHROMA_ONE);
        v = average(v_top + x * (SCALE / 2), v_rows.y, SCALE / 2, CHROMA_ONE);
#else
        average_both(u_top + x * SCALE, u_rows.y, SCALE / 2, CHROMA_ONE, &u, &v);
#endif
        STORE_YUV(y, u, v, short16, SHORTS)
    }
#elif defined(INTERLEAVED)
    /* 16 pixels at a time, the last ones overlapping those before. */
    const int place[3] = {channels.s1, channels.s2, channels.s3};
    sum_t sums[16 * CHANNELS];
    for (int x = 0; x < low_width; x += 16 / SCALE) {
        const int from = min(x, low_width - 16 / SCALE);
        for (int part = 0; part < CHANNELS; part++) {
            __global const uchar *samples = top + (from * SCALE * CHANNELS + 16 * part) * LUMA_BYTES;
            sums_t sum = 0;
            UNROLL
            for (int j = 0; j < SCALE; j++)
                sum += ADD_SAMPLES(samples + step * (ulong)j);
            vstore16(sum, part, sums);
        }
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < 16 / SCALE; i++) {
                uint sum = 0;
                for (int k = 0; k < SCALE; k++)
                    sum += sums[(i * SCALE + k) * CHANNELS + place[c]];
                row[c * colour + from + i] = (short)TO_COLOUR(sum);
            }
    }
#else
    for (int x = 0; x < low_width; x++) {
        const short y = average_any(top + x * SCALE * LUMA_BYTES, step, LUMA_BYTES, SCALE, COLOUR_ONE);
        row[x] = row[colour + x] = row[2 * colour + x] = y;
    }
#endif
}
