/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The reference R = mean_z I (6) of Oliva-García 2022, in YUV of 8 bits, rounded down (its only use is to choose cells
 * of the bilateral grid).
 */

__kernel void mean_luma(__global const uchar *stack, __global const ulong2 *rows, __global uchar *mean, int width,
                        int planes)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    float sum = 0.0f;
    for (int z = 0; z < planes; z++)
        sum += luma_at(stack, rows[z], x, y);
    mean[(ulong)y * width + x] = (uchar)(sum / planes);
}

/* Mean of one chroma component that the stack holds (I420, NV12): sample (x / 2) * step + first of the rows that the
 * table has from `first_row` on. */
__kernel void mean_chroma(__global const uchar *stack, __global const ulong2 *rows, int first_row,
                          __global uchar *mean, int width, int planes, int step, int first)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    uint sum = 0;
    for (int z = 0; z < planes; z++)
        sum += stack[rows[first_row + z].x + rows[first_row + z].y * (ulong)(y / 2) + (ulong)(x / 2 * step + first)];
    mean[(ulong)y * width + x] = (uchar)(sum / planes);
}

/* U = 128 + 0.492 (B - Y), V = 128 + 0.877 (R - Y) of the mean of interleaved colours.
 * channels = (samples a pixel, index of R, G, B). */
__kernel void mean_chroma_of_colours(__global const uchar *stack, __global const ulong2 *rows, __global uchar *mean_u,
                                     __global uchar *mean_v, int width, int planes, int4 channels)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    float3 sum = (float3)(0.0f);
    for (int z = 0; z < planes; z++) {
        __global const uchar *row = stack + rows[z].x + rows[z].y * (ulong)y;
        const ulong pixel = (ulong)x * channels.s0;
        sum += (float3)(dn_of(row, pixel + channels.s1), dn_of(row, pixel + channels.s2), dn_of(row, pixel + channels.s3));
    }
    sum /= planes;
    const float luma = 0.299f * sum.x + 0.587f * sum.y + 0.114f * sum.z;
    const ulong pixel = (ulong)y * width + x;
    mean_u[pixel] = convert_uchar_sat(128.0f + 0.492f * (sum.z - luma));
    mean_v[pixel] = convert_uchar_sat(128.0f + 0.877f * (sum.x - luma));
}
