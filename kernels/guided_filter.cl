/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Colour guided filter (He, Sun, Tang 2013) of each plane of a cost volume C by the guide A of three colours:
 *
 *     a = (cov(A, A) + EPSILON 1)^-1 cov(A, C),  b = mean C - a mean A,  filtered = mean a . A + mean b
 *
 * over windows of 2 RADIUS + 1 cells. `system` holds, for each cell, the inverse's 6 numbers and mean A: 9 low
 * pictures that all planes share. Sums over a window are taken over columns first, into the work-item's own `scratch`
 * rows, then over rows.
 */
#include "low_picture.cl"

#define EPSILON 30.0f
#define AREA ((2 * RADIUS + 1) * (2 * RADIUS + 1))

/* Sum of 2 RADIUS + 1 neighbouring column sums. */
inline float8 along_row(__global const float *sums)
{
    float8 sum = READ_CELLS(sums);
    for (int i = 1; i <= RADIUS; i++)
        sum += READ_CELLS(sums - i) + READ_CELLS(sums + i);
    return sum;
}

/* Radii above the base one are for noise only. */
inline int is_idle(__global const Noise *noise)
{
    return RADIUS > 1 && noise->t <= 0.1f;
}

/* The sides of the guide must be mirrored. Work-items (1, low height); scratch: 9 rows for each. */
__kernel void guide_system(__global const float *guide, __global const Noise *noise, __global float *system,
                           __global float *scratch, int width, int stride)
{
    if (is_idle(noise))
        return;
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t picture = (size_t)height * stride, row = (size_t)y * stride + SIDE;
    __global float *sums = scratch + (size_t)y * 9 * stride + SIDE;
    for (int x = -8; x < width + 8; x += 8) {
        float8 r = 0.0f, g = 0.0f, b = 0.0f, rr = 0.0f, rg = 0.0f, rb = 0.0f, gg = 0.0f, gb = 0.0f, bb = 0.0f;
        for (int j = -RADIUS; j <= RADIUS; j++) {
            __global const float *cells = guide + (size_t)reflect(y + j, height) * stride + SIDE + x;
            const float8 red = READ_CELLS(cells), green = READ_CELLS(cells + picture),
                         blue = READ_CELLS(cells + 2 * picture);
            r += red;
            g += green;
            b += blue;
            rr += red * red;
            rg += red * green;
            rb += red * blue;
            gg += green * green;
            gb += green * blue;
            bb += blue * blue;
        }
        const float8 all[9] = {r, g, b, rr, rg, rb, gg, gb, bb};
        for (int i = 0; i < 9; i++)
            CELLS(sums + i * stride + x) = all[i];
    }
    for (int x = 0; x < width; x += 8) {
        float8 mean[9];
        for (int i = 0; i < 9; i++)
            mean[i] = along_row(sums + i * stride + x) * (1.0f / AREA);
        const float8 r = mean[0], g = mean[1], b = mean[2];
        const float8 rr = mean[3] - r * r + EPSILON, rg = mean[4] - r * g, rb = mean[5] - r * b,
                     gg = mean[6] - g * g + EPSILON, gb = mean[7] - g * b, bb = mean[8] - b * b + EPSILON;
        const float8 irr = gg * bb - gb * gb, irg = gb * rb - rg * bb, irb = rg * gb - gg * rb,
                     igg = rr * bb - rb * rb, igb = rg * rb - rr * gb, ibb = rr * gg - rg * rg;
        const float8 scale = 1.0f / (rr * irr + rg * irg + rb * irb);
        const float8 all[9] = {irr * scale, irg * scale, irb * scale, igg * scale, igb * scale,
                               ibb * scale, r,           g,           b};
        for (int i = 0; i < 9; i++)
            CELLS(system + i * picture + row + x) = all[i];
    }
}

/* coefficients[z][a red, a green, a blue, b]. The sides of guide and cost must be mirrored. One work-item takes STRIP
 * rows of one plane: work-items (1, strips, planes); scratch: 4 rows for each. */
__kernel void fit(__global const float *cost, __global const float *guide, __global const float *system,
                  __global const Noise *noise, __global float *coefficients, __global float *scratch, int width,
                  int height, int stride)
{
    if (is_idle(noise))
        return;
    const size_t picture = (size_t)height * stride;
    const int z = (int)get_global_id(2), first = (int)get_global_id(1) * STRIP, last = min(first + STRIP, height);
    __global const float *plane = cost + z * picture + SIDE;
    __global float *fitted = coefficients + 4 * z * picture + SIDE;
    __global float *sums = scratch + ((size_t)z * get_global_size(1) + get_global_id(1)) * 4 * stride + SIDE;
    for (int y = first; y < last; y++) {
        for (int x = -8; x < width + 8; x += 8) {
            float8 c = 0.0f, rc = 0.0f, gc = 0.0f, bc = 0.0f;
            for (int j = -RADIUS; j <= RADIUS; j++) {
                const size_t row = (size_t)reflect(y + j, height) * stride + x;
                __global const float *colours = guide + SIDE + row;
                const float8 value = READ_CELLS(plane + row);
                c += value;
                rc += value * READ_CELLS(colours);
                gc += value * READ_CELLS(colours + picture);
                bc += value * READ_CELLS(colours + 2 * picture);
            }
            CELLS(sums + x) = c;
            CELLS(sums + stride + x) = rc;
            CELLS(sums + 2 * stride + x) = gc;
            CELLS(sums + 3 * stride + x) = bc;
        }
        for (int x = 0; x < width; x += 8) {
            __global const float *cell = system + (size_t)y * stride + SIDE + x;
            const float8 r = READ_CELLS(cell + 6 * picture), g = READ_CELLS(cell + 7 * picture),
                         b = READ_CELLS(cell + 8 * picture);
            const float8 c = along_row(sums + x) * (1.0f / AREA);
            const float8 rc = along_row(sums + stride + x) * (1.0f / AREA) - r * c;
            const float8 gc = along_row(sums + 2 * stride + x) * (1.0f / AREA) - g * c;
            const float8 bc = along_row(sums + 3 * stride + x) * (1.0f / AREA) - b * c;
            const float8 irg = READ_CELLS(cell + picture), irb = READ_CELLS(cell + 2 * picture),
                         igb = READ_CELLS(cell + 4 * picture);
            const float8 red = READ_CELLS(cell) * rc + irg * gc + irb * bc;
            const float8 green = irg * rc + READ_CELLS(cell + 3 * picture) * gc + igb * bc;
            const float8 blue = irb * rc + igb * gc + READ_CELLS(cell + 5 * picture) * bc;
            __global float *out = fitted + (size_t)y * stride + x;
            CELLS(out) = red;
            CELLS(out + picture) = green;
            CELLS(out + 2 * picture) = blue;
            CELLS(out + 3 * picture) = c - red * r - green * g - blue * b;
        }
    }
}

/* filtered <- MIX of filtered and this: t with a radius for noise, all of it otherwise. The sides of the coefficients
 * must be mirrored. Work-items as for fit(). */
__kernel void apply(__global const float *coefficients, __global const float *guide, __global const Noise *noise,
                    __global float *filtered, __global float *scratch, int width, int height, int stride)
{
    if (is_idle(noise))
        return;
    const float share = (RADIUS > 1 ? noise->t : 1.0f) / AREA, kept = RADIUS > 1 ? 1.0f - noise->t : 0.0f;
    const size_t picture = (size_t)height * stride;
    const int z = (int)get_global_id(2), first = (int)get_global_id(1) * STRIP, last = min(first + STRIP, height);
    __global const float *fitted = coefficients + 4 * z * picture + SIDE;
    __global float *sums = scratch + ((size_t)z * get_global_size(1) + get_global_id(1)) * 4 * stride + SIDE;
    for (int y = first; y < last; y++) {
        for (int i = 0; i < 4; i++)
            for (int x = -8; x < width + 8; x += 8) {
                float8 sum = 0.0f;
                for (int j = -RADIUS; j <= RADIUS; j++)
                    sum += READ_CELLS(fitted + i * picture + (size_t)reflect(y + j, height) * stride + x);
                CELLS(sums + i * stride + x) = sum;
            }
        for (int x = 0; x < width; x += 8) {
            __global const float *colours = guide + (size_t)y * stride + SIDE + x;
            const float8 value = along_row(sums + x) * READ_CELLS(colours) +
                                 along_row(sums + stride + x) * READ_CELLS(colours + picture) +
                                 along_row(sums + 2 * stride + x) * READ_CELLS(colours + 2 * picture) +
                                 along_row(sums + 3 * stride + x);
            __global float *out = filtered + z * picture + (size_t)y * stride + SIDE + x;
            CELLS(out) = RADIUS > 1 ? kept * READ_CELLS(out) + share * value : share * value;
        }
    }
}
