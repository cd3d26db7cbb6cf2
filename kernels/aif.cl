/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * All-in-focus picture from a stack and a depth map: each sample is taken from the planes around the depth's plane
 * position u. Samples are SAMPLE, uchar or ushort. `positions` gives u for each depth pixel value, below 0 where there
 * is none; there all planes count alike.
 *
 * One component at a time; subsampled chroma (subsampling 2) uses the mean position of its pixels that have one.
 */
#include "noise_type.cl"

inline float position_of(__global const ushort *depth, __global const float *positions, int depth_stride, int x, int y,
                         int width, int height, int subsampling)
{
    float sum = 0.0f;
    int known = 0;
    for (int j = y * subsampling; j < min((y + 1) * subsampling, height); j++)
        for (int i = x * subsampling; i < min((x + 1) * subsampling, width); i++) {
            const float u = positions[depth[(ulong)j * depth_stride + i]];
            sum += u >= 0.0f ? u : 0.0f;
            known += u >= 0.0f;
        }
    return known ? sum / known : -1.0f;
}

inline float sample_at(__global const uchar *stack, ulong2 rows, int x, int y)
{
    return (float)*(__global const SAMPLE *)(stack + rows.x + rows.y * (ulong)y + (ulong)x * sizeof(SAMPLE));
}

inline float mean_sample(__global const uchar *stack, __global const ulong2 *rows, int x, int y, int planes)
{
    float sum = 0.0f;
    for (int z = 0; z < planes; z++)
        sum += sample_at(stack, rows[z], x, y);
    return sum / planes;
}

/* How much steeper than its distance a plane's share is: without noise by a half, since the nearer of two planes is the
 * sharper one; in noise not at all, where two planes have less of it than one. */
inline float steepness_of(__global const Noise *noise)
{
    return 0.5f * clamp(1.0f - 2.0f * noise->t, 0.0f, 1.0f);
}

/* Between the two planes around u: with s the distance to the first, the second's share is s + steepness (s - 1/2). */
inline float linear_sample(__global const uchar *stack, __global const ulong2 *rows, int x, int y, float u, int planes,
                           float steepness)
{
    const int z = min((int)u, planes - 2);
    const float share = clamp(u - z + steepness * (u - z - 0.5f), 0.0f, 1.0f);
    return mix(sample_at(stack, rows[z], x, y), sample_at(stack, rows[z + 1], x, y), share);
}

/* Mean weighted by exp(-(z - u)^2 / (2 SOFT_PLANES^2)): less noise than two planes have. */
#define SOFT_PLANES 0.6f

inline float soft_sample(__global const uchar *stack, __global const ulong2 *rows, int x, int y, float u, int planes)
{
    const int from = max((int)u - 2, 0), to = min((int)u + 3, planes - 1);
    float sum = 0.0f, weights = 0.0f;
    for (int z = from; z <= to; z++) {
        const float weight = exp(-(z - u) * (z - u) / (2.0f * SOFT_PLANES * SOFT_PLANES));
        sum += weight * sample_at(stack, rows[z], x, y);
        weights += weight;
    }
    return sum / weights;
}

/* The soft mean where it `is_soft` and there is noise: in silence it would only lose sharpness.
 * Writes the samples of one component, whose rows the table has from `first_row` on; `channels` interleaved samples
 * share a depth pixel. */
__kernel void compose(__global const uchar *stack, __global const ulong2 *table, int first_row,
                      __global const ushort *depth, __global const float *positions, __global uchar *picture,
                      ulong2 picture_rows, int2 component_size, int channels, int subsampling, int2 depth_size,
                      int depth_stride, int planes, __global const Noise *noise, int is_soft)
{
    __global const ulong2 *rows = table + first_row;
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= component_size.x)
        return;
    const float u = position_of(depth, positions, depth_stride, x / channels, y, depth_size.x, depth_size.y, subsampling);
    float value;
    if (u < 0.0f)
        value = mean_sample(stack, rows, x, y, planes);
    else if (is_soft && noise->t > 0.5f)
        value = soft_sample(stack, rows, x, y, u, planes);
    else
        value = linear_sample(stack, rows, x, y, u, planes, steepness_of(noise));
    __global uchar *sample = picture + picture_rows.x + picture_rows.y * (ulong)y + (ulong)x * sizeof(SAMPLE);
    *(__global SAMPLE *)sample = (SAMPLE)(value + 0.5f);
}
