/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Colour on the left, depth on the right in gray: near is white, or black with invert; no depth counts as far.
 */
__kernel void rgbd(__global const uchar *color, ulong color_stride, __global const uchar *depth, ulong depth_stride,
                   __global const float *positions, int2 size, int invert, __global uchar *output, ulong stride, int channels)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= 2 * size.x)
        return;
    __global uchar *pixel = output + stride * (ulong)y + (ulong)x * channels;
    uchar4 value;
    if (x < size.x) {
        __global const uchar *source = color + color_stride * (ulong)y + (ulong)x * channels;
        value = channels == 4 ? *(__global const uchar4 *)source : (uchar4)(source[0], source[1], source[2], 255);
    } else {
        const float u = positions[*(__global const ushort *)(depth + depth_stride * (ulong)y + 2ul * (x - size.x))];
        const float nearness = isnan(u) ? 0.0f : 1.0f - u;
        value = (uchar4)((uchar3)convert_uchar_sat_rte(255.0f * (invert ? 1.0f - nearness : nearness)), 255);
    }
    if (channels == 4) {
        *(__global uchar4 *)pixel = value;
        return;
    }
    pixel[0] = value.x;
    pixel[1] = value.y;
    pixel[2] = value.z;
}
