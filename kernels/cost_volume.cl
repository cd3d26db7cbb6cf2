/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Cost of each plane at each cell, from the focus volumes; flat where there is no texture:
 *
 *     T = max_z F,  S = T - min_z F
 *     C0 = (T0 - F0) / (T0 + 1.5 med T0 + 4)
 *     C  = C0 + t (1 - k0)^2 (T1 - F1) / (S1 + 4 (med S1 + 0.5)),  k0 = S0 / (S0 + 0.5 (med S0 + 2))
 *
 * F0 is the fine band (focus_volume.cl); F1 the coarse one, SML with taps 2 apart of the blurred colours, which speaks
 * only in noise (t > QUIET) and where the fine one is silent.
 */
#include "low_picture.cl"

/* Smooths a focus volume by [.7t 2 .7t] / (2 + 1.4t) along z, in place; top = T, range = S.
 * Work-items (1, low height). */
__kernel void evidence(__global float *focus, __global const Noise *noise, __global float *top,
                       __global float *range, int only_in_noise, int width, int stride, int planes)
{
    if (only_in_noise && noise->t <= QUIET)
        return;
    const size_t row = get_global_id(1) * stride + SIDE, plane = get_global_size(1) * stride;
    const float side = 0.7f * noise->t / (2.0f + 1.4f * noise->t), centre = 2.0f / (2.0f + 1.4f * noise->t);
    for (int x = 0; x < width; x += 8) {
        __global float *cells = focus + row + x;
        float8 before = READ_CELLS(cells), here = before, highest = 0.0f, lowest = INFINITY;
        for (int z = 0; z < planes; z++) {
            const float8 after = READ_CELLS(cells + min(z + 1, planes - 1) * plane);
            const float8 smooth = side * (before + after) + centre * here;
            CELLS(cells + z * plane) = smooth;
            highest = max(highest, smooth);
            lowest = min(lowest, smooth);
            before = here;
            here = after;
        }
        CELLS(top + row + x) = highest;
        CELLS(range + row + x) = highest - lowest;
    }
}

/* value -> share of the cells below it that is wanted, by a histogram whose bins grow with the value: 64 an octave of
 * 1 + scale * value. One work-item. */
#define BINS 1024

__kernel void quantile(__global const float *picture, __global float *result, float share, float scale, int width,
                       int height, int stride)
{
    uint histogram[BINS];
    for (int i = 0; i < BINS; i++)
        histogram[i] = 0;
    const int step = width * height > 65536 ? 3 : 1;
    uint count = 0;
    for (int y = 0; y < height; y += step)
        for (int x = 0; x < width; x += step, count++) {
            const uint bits = as_uint(1.0f + scale * picture[(size_t)y * stride + SIDE + x]) - as_uint(1.0f);
            histogram[min(bits >> 17, (uint)(BINS - 1))]++;
        }
    float wanted = share * count;
    int bin = 0;
    while (bin < BINS - 1 && wanted > histogram[bin])
        wanted -= histogram[bin++];
    const float place = bin + wanted / max(histogram[bin], 1u);
    *result = (as_float(as_uint(1.0f) + (uint)(place * (1 << 17))) - 1.0f) / scale;
}

/* One work-item. */
__kernel void largest(__global const float *picture, __global float *result, int width, int height, int stride)
{
    float8 highest = 0.0f;
    for (int y = 0; y < height; y++)
        for (int x = 0; x + 8 <= width; x += 8)
            highest = max(highest, READ_CELLS(picture + (size_t)y * stride + SIDE + x));
    const float4 half_of_them = max(highest.lo, highest.hi);
    const float2 quarter = max(half_of_them.lo, half_of_them.hi);
    *result = max(quarter.x, quarter.y);
}

/* C0 of each plane. Work-items (1, low height, planes). */
__kernel void fine_cost(__global const float *focus, __global const float *top, __global const float *median_top,
                        __global float *cost, int width, int stride)
{
    const size_t row = get_global_id(1) * stride + SIDE;
    const size_t plane_row = row + get_global_id(2) * get_global_size(1) * stride;
    const float floor = 1.5f * *median_top + 4.0f;
    for (int x = 0; x < width; x += 8) {
        const float8 highest = READ_CELLS(top + row + x);
        CELLS(cost + plane_row + x) = (highest - READ_CELLS(focus + plane_row + x)) / (highest + floor);
    }
}

/* SML with taps 2 apart, the mean of the colours of `small` (blurred, sides mirrored). Work-items (1, low height,
 * planes). */
__kernel void coarse_focus(__global const float *small, __global const Noise *noise, __global float *focus,
                           int width, int stride)
{
    if (noise->t <= QUIET)
        return;
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t picture = (size_t)height * stride;
    __global float *out = focus + get_global_id(2) * picture + (size_t)y * stride + SIDE;
    for (int x = 0; x < width; x += 8) {
        float8 sum = 0.0f;
        for (int colour = 0; colour < 3; colour++) {
            __global const float *plane = small + (3 * get_global_id(2) + colour) * picture + SIDE + x;
            __global const float *row = plane + (size_t)y * stride;
            const float8 twice = 2.0f * READ_CELLS(row);
            sum += fabs(twice - READ_CELLS(row - 2) - READ_CELLS(row + 2)) +
                   fabs(twice - READ_CELLS(plane + (size_t)clamp(mirror(y - 2, height), 0, height - 1) * stride) -
                        READ_CELLS(plane + (size_t)clamp(mirror(y + 2, height), 0, height - 1) * stride));
        }
        CELLS(out + x) = sum * (1.0f / 3.0f);
    }
}

/* C = C0 and, in noise, the coarse band's cost. medians: of S0 and of S1. Work-items (1, low height, planes). */
__kernel void add_coarse_cost(__global const float *fine_cost, __global const float *focus, __global const float *top,
                              __global const float *fine_range, __global const float *range,
                              __global const float *median_fine_range, __global const float *median_range,
                              __global const Noise *noise, __global float *cost, int width, int stride)
{
    const size_t row = get_global_id(1) * stride + SIDE;
    const size_t plane_row = row + get_global_id(2) * get_global_size(1) * stride;
    const float silence = 0.5f * (*median_fine_range + 2.0f), floor = 4.0f * (*median_range + 0.5f);
    const float share = noise->t > QUIET ? noise->t : 0.0f;
    for (int x = 0; x < width; x += 8) {
        const float8 silent = silence / (READ_CELLS(fine_range + row + x) + silence); /* 1 - k0 */
        const float8 coarse = (READ_CELLS(top + row + x) - READ_CELLS(focus + plane_row + x)) /
                              (READ_CELLS(range + row + x) + floor);
        CELLS(cost + plane_row + x) = READ_CELLS(fine_cost + plane_row + x) + share * silent * silent * coarse;
    }
}
