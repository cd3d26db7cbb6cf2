/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The guide A at 1/SCALE: all small planes blended at a first guess of the depth, taken on its nearer side, since an
 * occlusion edge is sharp in the plane of its nearer side:
 *
 *     u0 = argmin_z box(C0),  u = min_3x3(median_5x5(u0)),  A = sum_z w_z small_z / sum_z w_z,
 *     w_z = exp(-(z - u)^2 / (2 s^2)),  s = .6 + .3 t;   in noise A is filtered bilaterally, range 4 sigma / SCALE
 */
#include "low_picture.cl"

/* Work-items (1, low height). */
__kernel void cheapest_plane(__global const float *cost, __global float *u, int width, int stride, int planes)
{
    const size_t row = get_global_id(1) * stride + SIDE, plane = get_global_size(1) * stride;
    for (int x = 0; x < width; x += 8) {
        float8 least = READ_CELLS(cost + row + x), best = 0.0f;
        for (int z = 1; z < planes; z++) {
            const float8 value = READ_CELLS(cost + z * plane + row + x);
            best = select(best, (float8)(z), value < least);
            least = min(least, value);
        }
        CELLS(u + row + x) = best;
    }
}

/* Sorts the least to the front and the greatest to the end. */
inline void part_extremes(float8 *values, int count)
{
    for (int i = 0; i < count / 2; i++) {
        const float8 a = values[i], b = values[count - 1 - i];
        values[i] = min(a, b);
        values[count - 1 - i] = max(a, b);
    }
    for (int i = 1; i <= (count - 1) / 2; i++) {
        const float8 a = values[0], b = values[i];
        values[0] = min(a, b);
        values[i] = max(a, b);
    }
    for (int i = count / 2; i < count - 1; i++) {
        const float8 a = values[i], b = values[count - 1];
        values[i] = min(a, b);
        values[count - 1] = max(a, b);
    }
}

/* Median 5x5 by forgetting: of 14 values the extremes cannot be the median of 25. The sides of u must be mirrored.
 * Work-items (1, low height). */
__kernel void median_5x5(__global const float *u, __global float *median, int width, int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    for (int x = 0; x < width; x += 8) {
        float8 values[14];
#define VALUE(k) READ_CELLS(u + (size_t)reflect(y + (k) / 5 - 2, height) * stride + SIDE + x + (k) % 5 - 2)
        for (int k = 0; k < 14; k++)
            values[k] = VALUE(k);
        for (int k = 14; k < 25; k++) {
            part_extremes(values, 28 - k);
            values[0] = VALUE(k);
        }
        part_extremes(values, 3);
        CELLS(median + (size_t)y * stride + SIDE + x) = values[1];
    }
}

/* The sides of u must be mirrored. Work-items (1, low height). */
__kernel void nearest_3x3(__global const float *u, __global float *nearer, int width, int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    for (int x = 0; x < width; x += 8) {
        float8 least = INFINITY;
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++)
                least = min(least, READ_CELLS(u + (size_t)reflect(y + j, height) * stride + SIDE + x + i));
        CELLS(nearer + (size_t)y * stride + SIDE + x) = least;
    }
}

/* guide[colour]: A before the bilateral filter. Work-items (1, low height). */
__kernel void blend_planes(__global const float *small, __global const float *u, __global const Noise *noise,
                           __global float *guide, int width, int stride, int planes)
{
    const size_t row = get_global_id(1) * stride + SIDE, picture = get_global_size(1) * stride;
    const float s = 0.6f + 0.3f * noise->t, steepness = -1.0f / (2.0f * s * s);
    for (int x = 0; x < width; x += 8) {
        const float8 position = READ_CELLS(u + row + x);
        float8 weights = 0.0f, red = 0.0f, green = 0.0f, blue = 0.0f;
        for (int z = 0; z < planes; z++) {
            const float8 distance = z - position;
            const float8 weight = quick_exp(steepness * distance * distance);
            __global const float *cells = small + 3 * z * picture + row + x;
            weights += weight;
            red += weight * READ_CELLS(cells);
            green += weight * READ_CELLS(cells + picture);
            blue += weight * READ_CELLS(cells + 2 * picture);
        }
        CELLS(guide + row + x) = red / weights;
        CELLS(guide + picture + row + x) = green / weights;
        CELLS(guide + 2 * picture + row + x) = blue / weights;
    }
}

/* Bilateral filter of radius 4: weights exp(-d^2 / (2 2^2) - e^2 / (2 range^2)), e = |dA|_1; a copy where there is
 * hardly any noise. The sides of the guide must be mirrored. Work-items (1, low height). */
__kernel void denoise(__global const float *guide, __global const Noise *noise, __global float *denoised, int width,
                      int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t picture = (size_t)height * stride, row = (size_t)y * stride + SIDE;
    const float range = 4.0f * noise->sigma / SCALE, steepness = -1.0f / (2.0f * range * range);
    const int radius = noise->sigma > 0.3f ? 4 : 0;
    for (int x = 0; x < width; x += 8) {
        const float8 red = READ_CELLS(guide + row + x), green = READ_CELLS(guide + picture + row + x),
                     blue = READ_CELLS(guide + 2 * picture + row + x);
        float8 weights = 1.0f, red_sum = red, green_sum = green, blue_sum = blue;
        for (int j = -radius; j <= radius; j++)
            for (int i = -radius; i <= radius; i++) {
                if (i * i + j * j > radius * radius || (i == 0 && j == 0))
                    continue;
                __global const float *cells = guide + (size_t)reflect(y + j, height) * stride + SIDE + x + i;
                const float8 r = READ_CELLS(cells), g = READ_CELLS(cells + picture),
                             b = READ_CELLS(cells + 2 * picture);
                const float8 e = fabs(r - red) + fabs(g - green) + fabs(b - blue);
                const float8 weight = quick_exp(steepness * e * e - (i * i + j * j) / 8.0f);
                weights += weight;
                red_sum += weight * r;
                green_sum += weight * g;
                blue_sum += weight * b;
            }
        CELLS(denoised + row + x) = red_sum / weights;
        CELLS(denoised + picture + row + x) = green_sum / weights;
        CELLS(denoised + 2 * picture + row + x) = blue_sum / weights;
    }
}
