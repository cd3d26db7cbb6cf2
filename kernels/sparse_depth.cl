/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Sparse depth (2), (5) of Oliva-García 2022: the place of the highest focus measure P in half planes, kept where
 *
 *     max_z P > 0,  max_z P >= tolerance * mean_z P,  max_z P >= mean_{x,y,z} P,
 *     max_z P >= 0.5 * its maximum in the 7x7 neighbourhood    (edge ridges only; the blurred skirts of strong edges
 *                                                               peak in wrong planes),
 *
 * and where the pixel did not move during the sweep. Elsewhere it is UNKNOWN_PLANE.
 */
#define RIDGE_RADIUS 3
#define RIDGE_SHARE 0.5f

/* Sum of each row of `mean`, one work-item a row. */
__kernel void sum_rows(__global const float *mean, __global float *row_sums, int width, int height)
{
    const int y = (int)get_global_id(0);
    if (y >= height)
        return;
    float sum = 0.0f;
    for (int x = 0; x < width; x++)
        sum += mean[(ulong)y * width + x];
    row_sums[y] = sum;
}

/* One work-item: the mean of P over the picture and the planes. */
__kernel void mean_of_rows(__global const float *row_sums, __global float *total_mean, int width, int height)
{
    float sum = 0.0f;
    for (int y = 0; y < height; y++)
        sum += row_sums[y] / width;
    *total_mean = sum / height;
}

/* Maximum over 7 pixels of a row. */
__kernel void row_maximum(__global const float *peak, __global float *maximum, int width)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    __global const float *row = peak + (ulong)y * width;
    float highest = row[x];
    for (int i = max(x - RIDGE_RADIUS, 0); i <= min(x + RIDGE_RADIUS, width - 1); i++)
        highest = fmax(highest, row[i]);
    maximum[(ulong)y * width + x] = highest;
}

__kernel void select_ridges(__global const float *peak, __global const uchar *place, __global const float *mean,
                            __global const float *row_maximum, __global const float *total_mean,
                            __global const uchar *moved, __global uchar *sparse, int width, int height, float tolerance,
                            int use_moved)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    const ulong pixel = (ulong)y * width + x;
    float highest = 0.0f;
    for (int j = max(y - RIDGE_RADIUS, 0); j <= min(y + RIDGE_RADIUS, height - 1); j++)
        highest = fmax(highest, row_maximum[(ulong)j * width + x]);

    const float p = peak[pixel];
    const int sharp = p > 0.0f && p >= tolerance * mean[pixel] && p >= *total_mean && p >= RIDGE_SHARE * highest;
    const int still = !use_moved || moved[pixel] == 0;
    sparse[pixel] = sharp && still ? place[pixel] : UNKNOWN_PLANE;
}

/* Confidence 0..255: how far the winning plane stands above the mean over the planes, 1 - mean_z P / max_z P, relative
 * to the most that is possible, 1 - 1 / planes. */
__kernel void focus_confidence(__global const float *peak, __global const float *mean, __global uchar *confidence,
                               int width, int planes)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    const ulong pixel = (ulong)y * width + x;
    const float above = peak[pixel] > 0.0f ? 1.0f - mean[pixel] / peak[pixel] : 0.0f;
    confidence[pixel] = convert_uchar_sat_rte(255.0f * above * planes / (planes - 1));
}
