/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The guide A at 1/SCALE: all small planes blended at a depth, first at a guess of it (u0 of cost_volume.cl), taken on
 * its nearer side, since an occlusion edge is sharp in the plane of its nearer side:
 *
 *     u = min_3x3(median_5x5(u0)),  A = sum_z w_z small_z / sum_z w_z,
 *     w_z = exp(-(z - u)^2 / (2 s^2)),  s = .6 + .3 t;   in noise A is filtered bilaterally, range 4 sigma / SCALE
 */
#include "low_picture.cl"

#define REACH 3.5f    /* times s: weights beyond are below 0.3 % */
#define DENOISED 0.3f /* DN of noise above which the guide is filtered */

/* Sorts the least to the front and the greatest to the end. */
INLINE void part_extremes(short16 *values, int count)
{
    UNROLL
    for (int i = 0; i < count / 2; i++) {
        const short16 a = values[i], b = values[count - 1 - i];
        values[i] = min(a, b);
        values[count - 1 - i] = max(a, b);
    }
    UNROLL
    for (int i = 1; i <= (count - 1) / 2; i++) {
        const short16 a = values[0], b = values[i];
        values[0] = min(a, b);
        values[i] = max(a, b);
    }
    UNROLL
    for (int i = count / 2; i < count - 1; i++) {
        const short16 a = values[i], b = values[count - 1];
        values[i] = min(a, b);
        values[count - 1] = max(a, b);
    }
}

/* Median 5x5 by forgetting: of 14 values the extremes cannot be the median of 25. The sides of u are mirrored, before and
 * after. Work-items (1, low height). */
__kernel void median_5x5(__global const short *u, __global float *median, int width, int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    __global float *out = median + (size_t)y * stride + SIDE;
    for (int x = 0; x < width; x += 16) {
        short16 values[14];
#define VALUE(k) READ_SHORTS(u + (size_t)reflect(y + (k) / 5 - 2, height) * stride + SIDE + x + (k) % 5 - 2)
        UNROLL
        for (int k = 0; k < 14; k++)
            values[k] = VALUE(k);
        UNROLL
        for (int k = 14; k < 25; k++) {
            part_extremes(values, 28 - k);
            values[0] = VALUE(k);
        }
        part_extremes(values, 3);
        CELLS(out + x) = convert_float8(values[1].lo);
        CELLS(out + x + 8) = convert_float8(values[1].hi);
    }
    mirror_ends(out, width);
}

/* nearer = min_3x3(u), guide[colour] = A before the bilateral filter, which goes to `silent_guide` where there will be
 * none. All sides are mirrored, before and after. Work-items (1, low height). */
__kernel void blend_planes(__global const short *small, __global const float *u, __global const Noise *noise,
                           __global float *nearer, __global float *guide, __global float *silent_guide, int width,
                           int stride, int planes)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t row = (size_t)y * stride + SIDE, picture = (size_t)height * stride;
    const float s = 0.6f + 0.3f * noise->t, steepness = -1.0f / (2.0f * s * s), reach = REACH * s;
    __global const float *above = u + (size_t)reflect(y - 1, height) * stride + SIDE, *here = u + row,
                         *below = u + (size_t)reflect(y + 1, height) * stride + SIDE;
    __global float *out = (noise->sigma > DENOISED ? guide : silent_guide) + row;
    for (int x = 0; x < width; x += 8) {
        float8 position = INFINITY;
        UNROLL
        for (int i = -1; i <= 1; i++)
            position = min(min(position, READ_CELLS(above + x + i)),
                           min(READ_CELLS(here + x + i), READ_CELLS(below + x + i)));
        CELLS(nearer + row + x) = position;

        float8 weights = 0.0f, red = 0.0f, green = 0.0f, blue = 0.0f;
        for (int z = 0; z < planes; z++) {
            const float8 distance = z - position;
            if (!any_of(fabs(distance) < reach))
                continue;
            const float8 weight = quick_exp(steepness * distance * distance);
            __global const short *cells = small + 3 * z * picture + row + x;
            weights += weight;
            red += weight * READ_SHORT_CELLS(cells);
            green += weight * READ_SHORT_CELLS(cells + picture);
            blue += weight * READ_SHORT_CELLS(cells + 2 * picture);
        }
        const float8 unit = 1.0f / (COLOUR_ONE * weights);
        CELLS(out + x) = red * unit;
        CELLS(out + picture + x) = green * unit;
        CELLS(out + 2 * picture + x) = blue * unit;
    }
    mirror_ends(nearer + row, width);
    for (int colour = 0; colour < 3; colour++)
        mirror_ends(out + colour * picture, width);
}

/* Bilateral filter of radius 4: weights exp(-d^2 / (2 2^2) - e^2 / (2 range^2)), e = |dA|_1. The sides are
 * mirrored, before and after. Work-items (1, low height). */
__kernel void denoise(__global const float *guide, __global const Noise *noise, __global float *denoised, int width,
                      int stride, int scale)
{
    if (noise->sigma <= DENOISED)
        return;
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t picture = (size_t)height * stride, row = (size_t)y * stride + SIDE;
    const float range = 4.0f * noise->sigma / scale, steepness = -1.0f / (2.0f * range * range);
    const int radius = 4;
    for (int x = 0; x < width; x += 8) {
        const float8 red = READ_CELLS(guide + row + x), green = READ_CELLS(guide + picture + row + x),
                     blue = READ_CELLS(guide + 2 * picture + row + x);
        float8 weights = 1.0f, red_sum = red, green_sum = green, blue_sum = blue;
        UNROLL
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
    for (int colour = 0; colour < 3; colour++)
        mirror_ends(denoised + colour * picture + row, width);
}
