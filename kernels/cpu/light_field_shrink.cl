/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The same as shrink_color of light_field_layers.cl, for CPUs: a work-item is a strip of rows; the rows of the source that one
 * of them covers are added up first, 16 bytes at a time.
 */
typedef uchar16 __attribute__((aligned(1))) uchar16_any;
typedef float4 __attribute__((aligned(4))) float4_any;

/* Adds `weight` times the bytes from `begin` to `end` of a row; `first`: there is nothing to add to yet. */
inline void add_row(__global const uchar *row, float weight, bool first, int begin, int end, __global float *sums)
{
    int i = begin;
    for (; i + 16 <= end; i += 16) {
        const float16 value = weight * convert_float16(*(__global const uchar16_any *)(row + i));
        __global float16 *sum = (__global float16 *)(sums + i - begin);
        *sum = first ? value : *sum + value;
    }
    for (; i < end; i++)
        sums[i - begin] = (first ? 0.0f : sums[i - begin]) + weight * row[i];
}

/* The pixels from `begin` to `end` of a row of the same width as the source's. */
inline void copy_row(__global const uchar *row, int channels, int begin, int end, __global uchar4 *color)
{
    for (int x = begin; x < end; x++)
        color[x] = (uchar4)(row[channels * x], row[channels * x + 1], row[channels * x + 2], 255);
}

/* Arguments as those of shrink_color; and sums_size floats of `sums` for each work-item. Work-items (strips). */
__kernel void shrink_color_rows(__global const uchar *source, ulong stride, int channels, int2 source_size,
                                __global uchar4 *color, int2 size, int2 columns, __global float *sums, int sums_size)
{
    const int strip = (int)get_global_id(0), strips = (int)get_global_size(0);
    const float2 scale = convert_float2(source_size) / convert_float2(size);
    const int begin = (int)(columns.x * scale.x), end = min((int)ceil(columns.y * scale.x), source_size.x);
    sums += (size_t)strip * sums_size;
    for (int y = size.y * strip / strips; y < size.y * (strip + 1) / strips; y++) {
        __global uchar4 *to = color + (size_t)y * size.x;
        if (source_size.x == size.x && source_size.y == size.y) {
            copy_row(source + stride * (ulong)y, channels, columns.x, columns.y, to);
            continue;
        }
        const float top = y * scale.y, bottom = min(top + scale.y, (float)source_size.y);
        for (int j = (int)top; j < bottom; j++)
            add_row(source + stride * (ulong)j, min(bottom, j + 1.0f) - max(top, (float)j), j == (int)top, begin * channels,
                    end * channels, sums);
        for (int x = columns.x; x < columns.y; x++) {
            const float left = x * scale.x, right = min(left + scale.x, (float)source_size.x);
            float4 sum = 0.0f; /* of three channels, and what stands behind them */
            for (int i = (int)left; i < right; i++) {
                __global const float *pixel = sums + (i - begin) * channels;
                sum += (min(right, i + 1.0f) - max(left, (float)i)) * *(__global const float4_any *)pixel;
            }
            const float4 mean = sum / ((right - left) * (bottom - top));
            to[x] = convert_uchar4((float4)(mean.xyz + 0.5f, 255.0f));
        }
    }
}
