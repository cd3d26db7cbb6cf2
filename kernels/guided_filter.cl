/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Colour guided filter (He, Sun, Tang 2013) of each plane of a cost volume C by the guide A of three colours:
 *
 *     a = (cov(A, A) + EPSILON 1)^-1 cov(A, C),  b = mean C - a mean A,  filtered = mean a . A + mean b
 *
 * over windows of 5x5 cells with the weights [t 1 1 1 t] in both directions: 3x3 in silence, 5x5 in noise. `system` holds,
 * for each cell, the inverse's 6 numbers and mean A: 9 low pictures that all planes share. Costs are shorts. Sums over a
 * window are taken over columns first, then over rows; a work-item keeps them, and the last rows of a and b, in its own
 * `scratch` rows. The sides of guide and cost must be mirrored.
 */
#include "low_picture.cl"

#define EPSILON 30.0f
#define RING 8 /* rows of a and b kept; 5 are needed */

/* 0 where the noise asks for windows of 3x3. */
INLINE float rim_weight(__global const Noise *noise)
{
    return noise->t > QUIET ? noise->t : 0.0f;
}

INLINE float area(float rim)
{
    return (3.0f + 2.0f * rim) * (3.0f + 2.0f * rim);
}

/* Weight of the j-th row from the middle. */
#define ROW_WEIGHT(j) ((j) == -2 || (j) == 2 ? rim : 1.0f)

INLINE float16 along_row(__global const float *sums, const int radius, float rim)
{
    const float16 sum = READ_WIDE(sums) + READ_WIDE(sums - 1) + READ_WIDE(sums + 1);
    return radius > 1 ? sum + rim * (READ_WIDE(sums - 2) + READ_WIDE(sums + 2)) : sum;
}

INLINE void find_system_row(__global const float *guide, __global float *system, __global float *sums, int y,
                            const int radius, float rim, int width, int height, int stride)
{
    const size_t picture = (size_t)height * stride;
    for (int x = -16; x < width + 8; x += 16) {
        float16 r = 0.0f, g = 0.0f, b = 0.0f, rr = 0.0f, rg = 0.0f, rb = 0.0f, gg = 0.0f, gb = 0.0f, bb = 0.0f;
        UNROLL
        for (int j = -radius; j <= radius; j++) {
            __global const float *cells = guide + (size_t)reflect(y + j, height) * stride + SIDE + x;
            const float16 red = READ_WIDE(cells), green = READ_WIDE(cells + picture),
                         blue = READ_WIDE(cells + 2 * picture);
            const float16 red_part = ROW_WEIGHT(j) * red, green_part = ROW_WEIGHT(j) * green,
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
        const float16 all[9] = {r, g, b, rr, rg, rb, gg, gb, bb};
        UNROLL
        for (int i = 0; i < 9; i++)
            WIDE(sums + i * stride + x) = all[i];
    }
    const float share = 1.0f / area(rim);
    for (int x = 0; x < width; x += 16) {
        float16 mean[9];
        UNROLL
        for (int i = 0; i < 9; i++)
            mean[i] = along_row(sums + i * stride + x, radius, rim) * share;
        const float16 r = mean[0], g = mean[1], b = mean[2];
        const float16 rr = mean[3] - r * r + EPSILON, rg = mean[4] - r * g, rb = mean[5] - r * b,
                     gg = mean[6] - g * g + EPSILON, gb = mean[7] - g * b, bb = mean[8] - b * b + EPSILON;
        const float16 irr = gg * bb - gb * gb, irg = gb * rb - rg * bb, irb = rg * gb - gg * rb,
                     igg = rr * bb - rb * rb, igb = rg * rb - rr * gb, ibb = rr * gg - rg * rg;
        const float16 scale = 1.0f / (rr * irr + rg * irg + rb * irb);
        const float16 all[9] = {irr * scale, irg * scale, irb * scale, igg * scale, igb * scale,
                               ibb * scale, r,           g,           b};
        UNROLL
        for (int i = 0; i < 9; i++)
            WIDE(system + i * picture + (size_t)y * stride + SIDE + x) = all[i];
    }
}

/* Work-items (1, strips); scratch: 9 rows for each. */
__kernel void guide_system(__global const float *guide, __global const Noise *noise, __global float *system,
                           __global float *scratch, int width, int height, int stride, int strip)
{
    const float rim = rim_weight(noise);
    const int first = (int)get_global_id(1) * strip, last = min(first + strip, height);
    __global float *sums = scratch + get_global_id(1) * 9 * (size_t)stride + SIDE;
    for (int y = first; y < last; y++)
        if (rim > 0.0f)
            find_system_row(guide, system, sums, y, 2, rim, width, height, stride);
        else
            find_system_row(guide, system, sums, y, 1, 0.0f, width, height, stride);
}

/* a and b of a row of one plane, their sides mirrored. */
INLINE void fit_row(__global const short *cost, __global const float *guide, __global const float *system,
                    __global float *fitted, __global float *sums, int y, const int radius, float rim, int width,
                    int height, int stride)
{
    const size_t picture = (size_t)height * stride;
    for (int x = -16; x < width + 8; x += 16) {
        float16 c = 0.0f, rc = 0.0f, gc = 0.0f, bc = 0.0f;
        UNROLL
        for (int j = -radius; j <= radius; j++) {
            const size_t cell = (size_t)reflect(y + j, height) * stride + SIDE + x;
            const float16 value = ROW_WEIGHT(j) * READ_WIDE_SHORTS(cost + cell);
            c += value;
            rc += value * READ_WIDE(guide + cell);
            gc += value * READ_WIDE(guide + picture + cell);
            bc += value * READ_WIDE(guide + 2 * picture + cell);
        }
        WIDE(sums + x) = c;
        WIDE(sums + stride + x) = rc;
        WIDE(sums + 2 * stride + x) = gc;
        WIDE(sums + 3 * stride + x) = bc;
    }
    const float share = 1.0f / area(rim);
    for (int x = 0; x < width; x += 16) {
        __global const float *cell = system + (size_t)y * stride + SIDE + x;
        const float16 r = READ_WIDE(cell + 6 * picture), g = READ_WIDE(cell + 7 * picture),
                     b = READ_WIDE(cell + 8 * picture);
        const float16 c = along_row(sums + x, radius, rim) * share;
        const float16 rc = along_row(sums + stride + x, radius, rim) * share - r * c;
        const float16 gc = along_row(sums + 2 * stride + x, radius, rim) * share - g * c;
        const float16 bc = along_row(sums + 3 * stride + x, radius, rim) * share - b * c;
        const float16 irg = READ_WIDE(cell + picture), irb = READ_WIDE(cell + 2 * picture),
                     igb = READ_WIDE(cell + 4 * picture);
        const float16 red = READ_WIDE(cell) * rc + irg * gc + irb * bc;
        const float16 green = irg * rc + READ_WIDE(cell + 3 * picture) * gc + igb * bc;
        const float16 blue = irb * rc + igb * gc + READ_WIDE(cell + 5 * picture) * bc;
        WIDE(fitted + x) = red;
        WIDE(fitted + stride + x) = green;
        WIDE(fitted + 2 * stride + x) = blue;
        WIDE(fitted + 3 * stride + x) = c - red * r - green * g - blue * b;
    }
    UNROLL
    for (int i = 0; i < 4; i++)
        mirror_ends(fitted + i * stride, width);
}

/* Keeps SGM's sums within 16 bits. */
#define LARGEST_COST (3 * COST_ONE / 2)

/* Row y of the filtered plane from the rows of a and b around it, `row` 0 in the middle. */
#define FITTED(row) (ring + (size_t)(((row) + RING) % RING) * 4 * stride)

INLINE void apply_row(__global const float *ring, __global const float *colours, size_t picture,
                      __global short *filtered, __global float *sums, int y, const int radius, float rim, int width,
                      int stride)
{
    UNROLL
    for (int i = 0; i < 4; i++)
        for (int x = -16; x < width + 8; x += 16) {
            float16 sum = 0.0f;
            UNROLL
            for (int j = -radius; j <= radius; j++)
                sum += ROW_WEIGHT(j) * READ_WIDE(FITTED(y + j) + i * stride + x);
            WIDE(sums + i * stride + x) = sum;
        }
    const float share = 1.0f / area(rim);
    for (int x = 0; x < width; x += 16) {
        const float16 value = along_row(sums + x, radius, rim) * READ_WIDE(colours + x) +
                             along_row(sums + stride + x, radius, rim) * READ_WIDE(colours + picture + x) +
                             along_row(sums + 2 * stride + x, radius, rim) * READ_WIDE(colours + 2 * picture + x) +
                             along_row(sums + 3 * stride + x, radius, rim);
        SHORTS(filtered + x) =
            to_wide_shorts(clamp(share * value, (float16)(-LARGEST_COST), (float16)(LARGEST_COST)));
    }
}

INLINE void filter_strip(__global const short *cost, __global const float *guide, __global const float *system,
                         __global short *filtered, __global float *scratch, int first, int last, const int radius,
                         float rim, int width, int height, int stride)
{
    __global float *sums = scratch + SIDE, *ring = sums + 4 * stride;
    for (int y = first - radius; y < last + radius; y++) {
        fit_row(cost, guide, system, FITTED(y), sums, reflect(y, height), radius, rim, width, height, stride);
        const int done = y - radius;
        if (done >= first) {
            const size_t row = (size_t)done * stride + SIDE;
            apply_row(ring, guide + row, (size_t)height * stride, filtered + row, sums, done, radius, rim, width, stride);
        }
    }
}

/* One work-item takes `strip` rows of one plane: work-items (1, strips, planes); scratch: 4 + 4 RING rows for each. */
__kernel void filter_costs(__global const short *cost, __global const float *guide, __global const float *system,
                           __global const Noise *noise, __global short *filtered, __global float *scratch, int width,
                           int height, int stride, int strip)
{
    const float rim = rim_weight(noise);
    const size_t z = get_global_id(2), plane = z * (size_t)height * stride;
    const int first = (int)get_global_id(1) * strip, last = min(first + strip, height);
    __global float *own = scratch + (z * get_global_size(1) + get_global_id(1)) * (4 + 4 * RING) * (size_t)stride;
    if (rim > 0.0f)
        filter_strip(cost + plane, guide, system, filtered + plane, own, first, last, 2, rim, width, height, stride);
    else
        filter_strip(cost + plane, guide, system, filtered + plane, own, first, last, 1, 0.0f, width, height, stride);
}

/* Cells that are nearer by their filtered cost than the first guess has its nearest around them are not believed: what
 * would lie before its surroundings has edges that are sharp there. Their costs times 1 - (1 - t) d, d = nearer -
 * argmin_z filtered - 1 within 0..1; the matching then brings depth from around. `nearer` is that of guide_image.cl.
 * Work-items (1, low height). */
__kernel void doubt_nearer(__global short *filtered, __global const float *nearer, __global const Noise *noise,
                           int width, int stride, int planes)
{
    const size_t row = get_global_id(1) * stride + SIDE, plane = get_global_size(1) * stride;
    for (int x = 0; x < width; x += 16) {
        __global short *costs = filtered + row + x;
        short16 least = SHRT_MAX, best = 0;
        for (int z = 0; z < planes; z++) {
            const short16 value = READ_SHORTS(costs + z * plane);
            best = select(best, (short16)(short)z, value < least);
            least = min(least, value);
        }
        const float16 doubt = clamp(READ_WIDE(nearer + row + x) - convert_float16(best) - 1.0f, 0.0f, 1.0f);
        if (!any_of(doubt > 0.0f))
            continue;
        const float16 share = 1.0f - (1.0f - noise->t) * doubt;
        for (int z = 0; z < planes; z++)
            SHORTS(costs + z * plane) = to_wide_shorts(share * READ_WIDE_SHORTS(costs + z * plane));
    }
}
