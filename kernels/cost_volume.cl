/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Cost of each plane at each cell, from the focus volumes; flat where there is no texture:
 *
 *     F  = [.7t 2 .7t] / (2 + 1.4t) * focus, along z
 *     T  = max_z F,  S = T - min_z F
 *     C0 = (T0 - F0) / (T0 + q),  q = (.4 + .35t) med T0 + 1.5 + (8.5 - 6t) t: weak texture may speak where there is no
 *          noise, and must not where noise is weak: it is blurred least then, and most of it is left in F0
 *     C  = C0 + (1.4 - .4t) (1 - k0)^2 C1,     k0 = S0 / (S0 + 0.5 (med S0 + 2))
 *     u0 = argmin_z C + 4 (1 - k0)^2 C2,       Ci = (Ti - Fi) / (Si + 4 (med S1 + 0.5))
 *
 * F0 is the fine band (focus_volume.cl); F1 the coarse one, SML with taps 2 apart of the blurred colours, which speaks
 * where the fine one is silent: in noise, and between blurred edges, which it still sees. F2 is the mean of F1 around:
 * within its reach edges count more where they are sharp than blurred ones do anywhere, so that the first guess u0 is
 * right between edges, too, if not beside depth edges.
 *
 * Focus and costs are shorts, the sides of the costs are mirrored; T and S are floats in 1/FOCUS_ONE DN.
 */
#include "low_picture.cl"

/* F at plane z; `cells` are those of plane 0, `plane` apart. */
INLINE float16 smooth_focus(__global const short *cells, size_t plane, int z, int planes, float side, float centre)
{
    return side * (READ_WIDE_SHORTS(cells + max(z - 1, 0) * plane) +
                   READ_WIDE_SHORTS(cells + min(z + 1, planes - 1) * plane)) +
           centre * READ_WIDE_SHORTS(cells + z * plane);
}

#define SIDE_WEIGHT(noise) (0.7f * noise->t / (2.0f + 1.4f * noise->t))
#define CENTRE_WEIGHT(noise) (2.0f / (2.0f + 1.4f * noise->t))

/* top = T, range = S. Work-items (1, low height). */
__kernel void evidence(__global const short *focus, __global const Noise *noise, __global float *top,
                       __global float *range, int width, int stride, int planes)
{
    const size_t row = get_global_id(1) * stride + SIDE, plane = get_global_size(1) * stride;
    const float side = SIDE_WEIGHT(noise), centre = CENTRE_WEIGHT(noise);
    for (int x = 0; x < width; x += 16) {
        __global const short *cells = focus + row + x;
        float16 before = READ_WIDE_SHORTS(cells), here = before, highest = 0.0f, lowest = INFINITY;
        for (int z = 0; z < planes; z++) {
            const float16 after = READ_WIDE_SHORTS(cells + min(z + 1, planes - 1) * plane);
            const float16 smooth = side * (before + after) + centre * here;
            highest = max(highest, smooth);
            lowest = min(lowest, smooth);
            before = here;
            here = after;
        }
        WIDE(top + row + x) = highest;
        WIDE(range + row + x) = highest - lowest;
    }
}

/* value -> share of the cells below it that is wanted, by a histogram whose bins grow with the value: 64 an octave of
 * 1 + scale * value. */
#define BINS 1024

INLINE float quantile_of(__global const float *picture, float share, float scale, int width, int height, int stride)
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
    return (as_float(as_uint(1.0f) + (uint)(place * (1 << 17))) - 1.0f) / scale;
}

/* One work-item. */
__kernel void quantile(__global const float *picture, __global float *result, float share, float scale, int width,
                       int height, int stride)
{
    *result = quantile_of(picture, share, scale, width, height, stride);
}

/* medians of two pictures of T or S, in DN; the largest of the second. Work-items (1, 2). */
__kernel void summarise(__global const float *first, __global const float *second, __global float *medians,
                        __global float *largest, int width, int height, int stride)
{
    const int i = (int)get_global_id(1);
    medians[i] = quantile_of(i ? second : first, 0.5f, 1.0f / FOCUS_ONE, width, height, stride) / FOCUS_ONE;
    if (i == 0)
        return;
    float8 highest = 0.0f;
    for (int y = 0; y < height; y++)
        for (int x = 0; x + 8 <= width; x += 8)
            highest = max(highest, READ_CELLS(second + (size_t)y * stride + SIDE + x));
    const float4 half_of_them = max(highest.lo, highest.hi);
    const float2 quarter = max(half_of_them.lo, half_of_them.hi);
    *largest = max(quarter.x, quarter.y) / FOCUS_ONE;
}

/* C0. Work-items (1, low height, planes). */
__kernel void fine_cost(__global const short *focus, __global const float *top, __global const float *median_top,
                        __global const Noise *noise, __global short *cost, int width, int stride)
{
    const int z = (int)get_global_id(2), planes = (int)get_global_size(2);
    const size_t row = get_global_id(1) * stride + SIDE, plane = get_global_size(1) * stride;
    const float floor = ((0.4f + 0.35f * noise->t) * *median_top + 1.5f + (8.5f - 6.0f * noise->t) * noise->t) * FOCUS_ONE;
    const float side = SIDE_WEIGHT(noise), centre = CENTRE_WEIGHT(noise);
    __global short *costs = cost + z * plane + row;
    for (int x = 0; x < width; x += 16) {
        const float16 highest = READ_WIDE(top + row + x);
        const float16 focused = smooth_focus(focus + row + x, plane, z, planes, side, centre);
        SHORTS(costs + x) = to_wide_shorts(COST_ONE * (highest - focused) / (highest + floor));
    }
}

#define COARSE_BOX 3 /* radius */

/* (1 4 6 4 1) / 16 of samples at 0, of the means of those at -1 and 1, and of those at -2 and 2: a Gaussian of sigma 1. */
INLINE ushort16 binomial(ushort16 here, ushort16 near, ushort16 far)
{
    return mean_of(near, mean_of(mean_of(far, here), here));
}

/* The blurred colour's row y in 8ths of its unit, sides mirrored. */
INLINE void blur_row(__global const short *small, int y, int height, __global ushort *half_blurred,
                     __global ushort *blurred, int width, int stride)
{
#define SOURCE(i) (READ_USHORTS(small + (size_t)reflect(y + (i), height) * stride + x) << (ushort)3)
    for (int x = 0; x < width; x += 16)
        USHORTS(half_blurred + x) =
            binomial(SOURCE(0), mean_of(SOURCE(-1), SOURCE(1)), mean_of(SOURCE(-2), SOURCE(2)));
    mirror_short_ends((__global short *)half_blurred, width);
#define HALF_BLURRED(i) READ_USHORTS(half_blurred + x + (i))
    for (int x = 0; x < width; x += 16)
        USHORTS(blurred + x) = binomial(HALF_BLURRED(0), mean_of(HALF_BLURRED(-1), HALF_BLURRED(1)),
                                        mean_of(HALF_BLURRED(-2), HALF_BLURRED(2)));
    mirror_short_ends((__global short *)blurred, width);
}

/* F1 before it is smoothed along z, its sides mirrored: the mean over the colours of SML with taps 2 apart, in a box.
 * One work-item takes `strip` rows of one plane: work-items (1, strips, planes); scratch: 2 (strip + 10) rows for each.
 *
 * A blurred colour is in 1/(8 COLOUR_ONE) DN, the half of its SML at most 9/8 of 255 DN; SML of all colours is kept in
 * 1/4 DN, seven of which fit 16 bits. */
__kernel void coarse_focus(__global const short *small, __global short *focus, __global ushort *scratch, int width,
                           int height, int stride, int strip)
{
    const int z = (int)get_global_id(2), first = (int)get_global_id(1) * strip, last = min(first + strip, height);
    const int top = max(first - COARSE_BOX, 0), bottom = min(last + COARSE_BOX, height);
    const int blurred_top = max(top - 2, 0), blurred_bottom = min(bottom + 2, height);
    const size_t picture = (size_t)height * stride;
    __global ushort *blurred =
        scratch + (get_global_id(2) * get_global_size(1) + get_global_id(1)) * 2 * (strip + 10) * (size_t)stride + SIDE;
    __global ushort *sharpness = blurred + (strip + 10) * (size_t)stride;
    __global ushort *spare = sharpness + (strip + 8) * (size_t)stride;

    for (int colour = 0; colour < 3; colour++) {
        for (int y = blurred_top; y < blurred_bottom; y++)
            blur_row(small + (3 * z + colour) * picture + SIDE, y, height, spare,
                     blurred + (size_t)(y - blurred_top) * stride, width, stride);
        for (int y = top; y < bottom; y++) {
            __global const ushort *row = blurred + (size_t)(y - blurred_top) * stride;
            const int row_above = clamp(mirror(y - 2, height), 0, height - 1),
                      row_below = clamp(mirror(y + 2, height), 0, height - 1);
            __global const ushort *above = blurred + (size_t)(row_above - blurred_top) * stride;
            __global const ushort *below = blurred + (size_t)(row_below - blurred_top) * stride;
            __global ushort *out = sharpness + (size_t)(y - top) * stride;
            for (int x = 0; x < width; x += 16) {
                const ushort16 here = READ_USHORTS(row + x);
                const ushort16 half_sml =
                    difference(here, mean_of(READ_USHORTS(row + x - 2), READ_USHORTS(row + x + 2))) +
                    difference(here, mean_of(READ_USHORTS(above + x), READ_USHORTS(below + x)));
                const ushort16 sum = (half_sml >> (ushort)1) + (colour == 0 ? (ushort16)0 : READ_USHORTS(out + x));
                USHORTS(out + x) = colour == 2 ? (sum + (ushort)4) >> (ushort)3 : sum;
            }
            if (colour == 2)
                mirror_short_ends((__global short *)out, width);
        }
    }
    for (int y = first; y < last; y++) {
        __global const ushort *rows[2 * COARSE_BOX + 1];
        for (int j = -COARSE_BOX; j <= COARSE_BOX; j++)
            rows[j + COARSE_BOX] = sharpness + (size_t)(reflect(y + j, height) - top) * stride;
        for (int x = -16; x < width + 16; x += 16) {
            ushort16 sum = 0;
            UNROLL
            for (int j = 0; j < 2 * COARSE_BOX + 1; j++)
                sum += READ_USHORTS(rows[j] + x);
            USHORTS(spare + x) = PART_OF(sum, 65536 / (2 * COARSE_BOX + 1));
        }
        for (int x = 0; x < width; x += 16) {
            ushort16 sum = 0;
            UNROLL
            for (int i = -COARSE_BOX; i <= COARSE_BOX; i++)
                sum += READ_USHORTS(spare + x + i);
            SHORTS(focus + z * picture + (size_t)y * stride + SIDE + x) =
                as_short16(PART_OF(sum, 65536 * FOCUS_ONE / 4 / 3 / (2 * COARSE_BOX + 1)));
        }
        mirror_short_ends(focus + z * picture + (size_t)y * stride + SIDE, width);
    }
}

#define SILENCE(medians) (0.5f * ((medians)[1] + 2.0f) * FOCUS_ONE)
#define COARSE_FLOOR(medians) (4.0f * ((medians)[1] + 0.5f) * FOCUS_ONE)

/* (1 - k0)^2, k0 by the range S0. */
INLINE float16 silence_of(float16 fine_range, float silence)
{
    const float16 silent = silence / (fine_range + silence);
    return silent * silent;
}

/* C from C0, in place. medians: of S0 and of S1, the second of two each. Work-items (1, low height, planes). */
__kernel void add_coarse_cost(__global const short *focus, __global const float *top, __global const float *fine_range,
                              __global const float *range, __global const float *fine_medians,
                              __global const float *medians, __global const Noise *noise, __global short *cost,
                              int width, int stride)
{
    const int z = (int)get_global_id(2), planes = (int)get_global_size(2);
    const size_t row = get_global_id(1) * stride + SIDE, plane = get_global_size(1) * stride;
    const float silence = SILENCE(fine_medians), floor = COARSE_FLOOR(medians);
    const float side = SIDE_WEIGHT(noise), centre = CENTRE_WEIGHT(noise);
    const float share = COST_ONE * (1.4f - 0.4f * noise->t);
    __global short *costs = cost + z * plane + row;
    for (int x = 0; x < width; x += 16) {
        const float16 focused = smooth_focus(focus + row + x, plane, z, planes, side, centre);
        const float16 coarse = (READ_WIDE(top + row + x) - focused) / (READ_WIDE(range + row + x) + floor);
        SHORTS(costs + x) += to_wide_shorts(share * silence_of(READ_WIDE(fine_range + row + x), silence) * coarse);
    }
    mirror_short_ends(costs, width);
}

/* F2 before it is smoothed along z: the mean of 3x3 values of F1, `spacing` <= 8 cells apart, whose own boxes of 7x7
 * fill the square between them. Work-items (1, low height, planes). */
__kernel void widen_focus(__global const short *focus, __global short *wide, int spacing, int width, int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t plane = get_global_id(2) * (size_t)height * stride + SIDE;
    __global const short *above = focus + plane + (size_t)reflect(y - spacing, height) * stride;
    __global const short *here = focus + plane + (size_t)y * stride;
    __global const short *below = focus + plane + (size_t)reflect(y + spacing, height) * stride;
    __global short *out = wide + plane + (size_t)y * stride;
    for (int x = 0; x < width; x += 16) {
        ushort16 sum = 4; /* of eighths, nine of which fit 16 bits */
        UNROLL
        for (int i = -1; i <= 1; i++) {
            const int column = x + i * spacing;
            sum += (READ_USHORTS(above + column) >> (ushort)3) + (READ_USHORTS(here + column) >> (ushort)3) +
                   (READ_USHORTS(below + column) >> (ushort)3);
        }
        SHORTS(out + x) = as_short16(PART_OF(sum, 65536 * 8 / 9));
    }
}

/* u0, its sides mirrored. focus, top, range: of F2; medians as above. Work-items (1, low height). */
__kernel void first_guess(__global const short *cost, __global const short *focus, __global const float *top,
                          __global const float *fine_range, __global const float *range,
                          __global const float *fine_medians, __global const float *medians,
                          __global const Noise *noise, __global short *guess, int width, int stride, int planes)
{
    const size_t row = get_global_id(1) * stride + SIDE, plane = get_global_size(1) * stride;
    const float silence = SILENCE(fine_medians), floor = COARSE_FLOOR(medians);
    const float side = SIDE_WEIGHT(noise), centre = CENTRE_WEIGHT(noise);
    for (int x = 0; x < width; x += 16) {
        const float16 highest = READ_WIDE(top + row + x);
        const float16 share = 4.0f * COST_ONE * silence_of(READ_WIDE(fine_range + row + x), silence) /
                              (READ_WIDE(range + row + x) + floor);
        float16 least = INFINITY;
        short16 best = 0;
        for (int z = 0; z < planes; z++) {
            const float16 focused = smooth_focus(focus + row + x, plane, z, planes, side, centre);
            const float16 value = READ_WIDE_SHORTS(cost + z * plane + row + x) + share * (highest - focused);
            best = select(best, (short16)(short)z, convert_short16(value < least));
            least = min(least, value);
        }
        SHORTS(guess + row + x) = best;
    }
    mirror_short_ends(guess + row, width);
}
