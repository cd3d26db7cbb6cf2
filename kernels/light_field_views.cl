/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Views in columns and rows, view 0 at the bottom left, the next one to its right. What is left over at the right and at the
 * top is black. A pixel (X, Y) of a view looks along the ray from origin + scale (X, Y) with its view's slope.
 */
#include "light_field_trace.cl"

__kernel void views(LAYERS, __global const float *slopes, int2 columns_rows, int2 view, float2 first, float2 scale,
                    __global uchar *output, ulong stride, int channels, int2 output_size)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= output_size.x)
        return;
    const Layers layers = MAKE_LAYERS;
    const int column = x / view.x, row = (output_size.y - 1 - y) / view.y;
    float4 value = 0.0f;
    if (column < columns_rows.x && row < columns_rows.y) {
        const int2 pixel = (int2)(x - column * view.x, view.y - 1 - (output_size.y - 1 - y - row * view.y));
        const float slope = slopes[row * columns_rows.x + column];
        value = trace(&layers, first + scale * convert_float2(pixel), (float2)(slope, 0.0f));
    }
    put_color(output + stride * (ulong)y + (ulong)x * channels, channels, value);
}
