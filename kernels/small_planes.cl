/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The planes of a stack area-downsampled to 1/SCALE, in R, G, B of DN: low pictures small[z][colour].
 */
#include "low_picture.cl"

typedef uchar16 uchar16_anywhere __attribute__((aligned(1)));
typedef ushort16 ushort16_anywhere __attribute__((aligned(2)));

#define store16(v, pointer) *(__global float16_anywhere *)(pointer) = v
typedef float16 float16_anywhere __attribute__((aligned(4)));

/* Sums of BOX rows for 16 * count samples. */
inline void sum_rows(__global const uchar *top, ulong stride, ushort16 *sums, int count)
{
    for (int i = 0; i < count; i++) {
        sums[i] = 0;
        for (int j = 0; j < BOX; j++)
            sums[i] += convert_ushort16(*(__global const uchar16_anywhere *)(top + stride * (ulong)j + 16 * i));
    }
}

inline ushort16 add_pairs(ushort16 a, ushort16 b)
{
    return (ushort16)(a.even + a.odd, b.even + b.odd);
}

/* Sums of each BOX of 16 * BOX neighbours. */
inline ushort16 sum_along(ushort16 *sums)
{
    for (int count = BOX; count > 1; count /= 2)
        for (int i = 0; i < count / 2; i++)
            sums[i] = add_pairs(sums[2 * i], sums[2 * i + 1]);
    return sums[0];
}

inline ushort16 sum_block(__global const uchar *top, ulong stride)
{
    ushort16 sums[BOX];
    sum_rows(top, stride, sums, BOX);
    return sum_along(sums);
}

/* Averages squares of BOX samples of a component with CHANNELS interleaved channels, `bytes` each pixel of it.
 * `places` says which colour a channel is, -1 none. Work-items (1, low height, planes). */
__kernel void average_squares(__global const uchar *stack, __global const ulong2 *table, int first_row,
                              __global float *small, int width, int low_width, int stride, int4 places)
{
    const int low_y = (int)get_global_id(1), z = (int)get_global_id(2), low_height = (int)get_global_size(1);
    const ulong2 rows = table[first_row + z];
    __global const uchar *top = stack + rows.x + rows.y * (ulong)(low_y * BOX);
    __global float *out = small + ((size_t)(3 * z) * low_height + low_y) * stride + SIDE;
    const size_t colour = (size_t)low_height * stride;
    const int place[4] = {places.s0, places.s1, places.s2, places.s3};

#if SAMPLE_BYTES == 1
    int done = 0;
#if CHANNELS == 1
    for (; done + 16 <= low_width; done += 16)
        store16(convert_float16(sum_block(top + done * BOX, rows.y)) * (1.0f / (BOX * BOX)),
                out + place[0] * colour + done);
#elif CHANNELS == 2
    for (; done + 16 <= low_width; done += 16) {
        ushort16 sums[2 * BOX], first[BOX], second[BOX];
        sum_rows(top + 2 * done * BOX, rows.y, sums, 2 * BOX);
        for (int i = 0; i < BOX; i++) {
            first[i] = (ushort16)(sums[2 * i].even, sums[2 * i + 1].even);
            second[i] = (ushort16)(sums[2 * i].odd, sums[2 * i + 1].odd);
        }
        store16(convert_float16(sum_along(first)) * (1.0f / (BOX * BOX)), out + place[0] * colour + done);
        store16(convert_float16(sum_along(second)) * (1.0f / (BOX * BOX)), out + place[1] * colour + done);
    }
#endif
    ushort sums[16 * CHANNELS];
    for (int x = done; x < low_width; x += 16 / BOX) {
        const int from = min(x * BOX, width - 16), skipped = x * BOX - from;
        for (int part = 0; part < CHANNELS; part++) {
            ushort16 sum = 0;
            for (int j = 0; j < BOX; j++)
                sum += convert_ushort16(
                    *(__global const uchar16_anywhere *)(top + rows.y * (ulong)j + from * CHANNELS + 16 * part));
            vstore16(sum, part, sums);
        }
        for (int channel = 0; channel < CHANNELS; channel++)
            for (int i = 0; i < 16 / BOX && place[channel] >= 0; i++) {
                uint sum = 0;
                for (int k = 0; k < BOX; k++)
                    sum += sums[min(i * BOX + k + skipped, 15) * CHANNELS + channel];
                out[place[channel] * colour + x + i] = sum * (1.0f / (BOX * BOX));
            }
    }
#else
    for (int x = 0; x < low_width; x++) {
        uint sum = 0;
        for (int j = 0; j < BOX; j++)
            for (int k = 0; k < BOX; k++) {
                __global const uchar *sample = top + rows.y * (ulong)j + 2 * (x * BOX + k);
                sum += sample[0] | (uint)sample[1] << 8;
            }
        out[place[0] * colour + x] = sum * (255.0f / 65535.0f / (BOX * BOX));
    }
#endif
}

/* Y, U, V in the places of R, G, B -> R, G, B (BT.601, full range: the colours only have to part surfaces).
 * Work-items (1, low height, planes). */
__kernel void colours_of_yuv(__global float *small, int low_width, int stride)
{
    const size_t colour = get_global_size(1) * stride;
    __global float *row = small + get_global_id(2) * 3 * colour + get_global_id(1) * stride + SIDE;
    for (int x = 0; x < low_width; x += 8) {
        const float8 y = READ_CELLS(row + x);
        const float8 u = READ_CELLS(row + colour + x) - 128.0f, v = READ_CELLS(row + 2 * colour + x) - 128.0f;
        CELLS(row + x) = y + 1.402f * v;
        CELLS(row + colour + x) = y - 0.344f * u - 0.714f * v;
        CELLS(row + 2 * colour + x) = y + 1.772f * u;
    }
}

/* Y in the place of R -> R = G = B = Y. Work-items (1, low height, planes). */
__kernel void colours_of_gray(__global float *small, int low_width, int stride)
{
    const size_t colour = get_global_size(1) * stride;
    __global float *row = small + get_global_id(2) * 3 * colour + get_global_id(1) * stride + SIDE;
    for (int x = 0; x < low_width; x += 8)
        CELLS(row + colour + x) = CELLS(row + 2 * colour + x) = READ_CELLS(row + x);
}
