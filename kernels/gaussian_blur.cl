/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Separable Gaussian of 2 radius + 1 taps, mirrored at the borders. The paper's last step, which hides the blocks of
 * the bilateral grid: taps = sigma_xy * 1.2, sigma = 0.7 taps.
 */

__kernel void blur_rows(__global const float *source, __global float *blurred, __constant float *taps, int radius,
                        int width)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    __global const float *row = source + (ulong)y * width;
    float sum = 0.0f;
    for (int i = -radius; i <= radius; i++)
        sum += taps[i + radius] * row[mirror(x + i, width)];
    blurred[(ulong)y * width + x] = sum;
}

__kernel void blur_columns(__global const float *source, __global float *blurred, __constant float *taps, int radius,
                           int width, int height)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    float sum = 0.0f;
    for (int i = -radius; i <= radius; i++)
        sum += taps[i + radius] * source[(ulong)mirror(y + i, height) * width + x];
    blurred[(ulong)y * width + x] = sum;
}
