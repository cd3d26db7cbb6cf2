/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Colour guided filter (He, Sun, Tang 2013) of each plane of a cost volume C by the guide A of three colours:
 *
 *     a = (cov(A, A) + EPSILON 1)^-1 cov(A, C),  b = mean C - a mean A,  filtered = mean a . A + mean b
 *
 * over windows of 5x5 cells with the weights [t 1 1 1 t] in both directions: 3x3 in silence, 5x5 in noise. `system` holds, for each cell, the inverse's 6 numbers and mean A: 9 low
 * pictures that all planes share. Sums over a window are taken over columns first, into the work-item's own `scratch`
 * rows, then over rows.
 */
#include "low_picture.cl"

#define EPSILON 30.0f

inline float rim_weight(__global const Noise *noise)
{
    return noise->t > QUIET ? noise->t : 0.0f;
}

inline float area(float rim)
{
    return (3.0f + 2.0f * rim) * (3.0f + 2.0f * rim);
}

/* Weight of the j-th row from the middle, and how many rows count at all. */
#define ROW_WEIGHT(j) ((j) == -2 || (j) == 2 ? rim : 1.0f)
#define RADIUS (rim > 0.0f ? 2 : 1)

inline float8 along_row(__global const float *sums, float rim)
{
    const float8 sum = READ_CELLS(sums) + READ_CELLS(sums - 1) + READ_CELLS(sums + 1);
    return rim > 0.0f ? sum + rim * (READ_CELLS(sums - 2) + READ_CELLS(sums + 2)) : sum;
}

/* The sides of the guide must be mirrored. Work-items (1, low height); scratch: 9 rows for each. */
__kernel void guide_system(__global const float *guide, __global const Noise *noise, __global float *system,
                           __global float *scratch, int width, int stride)
{
    const float rim = rim_weight(noise), share = 1.0f / area(rim);
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t picture = (size_t)height * stride, row = (size_t)y * stride + SIDE;
    __global float *sums = scratch + (size_t)y * 9 * stride + SIDE;
    for (int x = -8; x < width + 8; x += 8) {
        float8 r = 0.0f, g = 0.0f, b = 0.0f, rr = 0.0f, rg = 0.0f, rb = 0.0f, gg = 0.0f, gb = 0.0f, bb = 0.0f;
        for (int j = -RADIUS; j <= RADIUS; j++) {
            __global const float *cells = guide + (size_t)reflect(y + j, height) * stride + SIDE + x;
            const float8 red = READ_CELLS(cells), green = READ_CELLS(cells + picture),
                         blue = READ_CELLS(cells + 2 * picture);
            const float8 red_part = ROW_WEIGHT(j) * red, green_part = ROW_WEIGHT(j) * green,
                         blue_part = ROW_WEIGHT(j) * blue;
            r += red_part;
            g += green_part;
            b += blue_part;
            rr += red_part * red;
            rg += red_part * green;
            rb += red_part * blue;
            gg += green_part * green;
            gb += green_part * blue;
            bb += blue_part * blue;
        }
        const float8 all[9] = {r, g, b, rr, rg, rb, gg, gb, bb};
        for (int i = 0; i < 9; i++)
            CELLS(sums + i * stride + x) = all[i];
    }
    for (int x = 0; x < width; x += 8) {
        float8 mean[9];
        for (int i = 0; i < 9; i++)
            mean[i] = along_row(sums + i * stride + x, rim) * share;
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
    const float rim = rim_weight(noise), share = 1.0f / area(rim);
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
                const float8 value = ROW_WEIGHT(j) * READ_CELLS(plane + row);
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
            const float8 c = along_row(sums + x, rim) * share;
            const float8 rc = along_row(sums + stride + x, rim) * share - r * c;
            const float8 gc = along_row(sums + 2 * stride + x, rim) * share - g * c;
            const float8 bc = along_row(sums + 3 * stride + x, rim) * share - b * c;
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

/* The sides of the coefficients must be mirrored. Work-items as for fit(). */
__kernel void apply(__global const float *coefficients, __global const float *guide, __global const Noise *noise,
                    __global float *filtered, __global float *scratch, int width, int height, int stride)
{
    const float rim = rim_weight(noise), share = 1.0f / area(rim);
    const size_t picture = (size_t)height * stride;
    const int z = (int)get_global_id(2), first = (int)get_global_id(1) * STRIP, last = min(first + STRIP, height);
    __global const float *fitted = coefficients + 4 * z * picture + SIDE;
    __global float *sums = scratch + ((size_t)z * get_global_size(1) + get_global_id(1)) * 4 * stride + SIDE;
    for (int y = first; y < last; y++) {
        for (int i = 0; i < 4; i++)
            for (int x = -8; x < width + 8; x += 8) {
                float8 sum = 0.0f;
                for (int j = -RADIUS; j <= RADIUS; j++)
                    sum += ROW_WEIGHT(j) * READ_CELLS(fitted + i * picture + (size_t)reflect(y + j, height) * stride + x);
                CELLS(sums + i * stride + x) = sum;
            }
        for (int x = 0; x < width; x += 8) {
            __global const float *colours = guide + (size_t)y * stride + SIDE + x;
            const float8 value = along_row(sums + x, rim) * READ_CELLS(colours) +
                                 along_row(sums + stride + x, rim) * READ_CELLS(colours + picture) +
                                 along_row(sums + 2 * stride + x, rim) * READ_CELLS(colours + 2 * picture) +
                                 along_row(sums + 3 * stride + x, rim);
            __global float *out = filtered + z * picture + (size_t)y * stride + SIDE + x;
            CELLS(out) = share * value;
        }
    }
}
