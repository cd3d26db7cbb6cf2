/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Colour and depth beside each other, each written from the byte `start` of the output on. Work-items of both (columns, rows of
 * the picture).
 */
inline void put(__global uchar *pixel, int channels, uchar4 value)
{
    if (channels == 4) {
        *(__global uchar4 *)pixel = value;
        return;
    }
    pixel[0] = value.x;
    pixel[1] = value.y;
    pixel[2] = value.z;
}

__kernel void place_color(__global const uchar *color, ulong color_stride, int width, __global uchar *output, ulong start,
                          ulong stride, int channels)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    __global const uchar *source = color + color_stride * (ulong)y + (ulong)x * channels;
    const uchar4 value = channels == 4 ? *(__global const uchar4 *)source : (uchar4)(source[0], source[1], source[2], 255);
    put(output + start + stride * (ulong)y + (ulong)x * channels, channels, value);
}

/* In gray: near is white, or black with invert; no depth counts as far. positions: as in light_field_layers.cl. */
__kernel void place_depth(__global const uchar *depth, ulong depth_stride, __global const float *positions, int width, int invert,
                          __global uchar *output, ulong start, ulong stride, int channels)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    const float u = positions[*(__global const ushort *)(depth + depth_stride * (ulong)y + 2ul * x)];
    const float nearness = isnan(u) ? 0.0f : 1.0f - u;
    const uchar gray = convert_uchar_sat_rte(255.0f * (invert ? 1.0f - nearness : nearness));
    put(output + start + stride * (ulong)y + (ulong)x * channels, channels, (uchar4)((uchar3)gray, 255));
}
