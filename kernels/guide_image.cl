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
#define NOISY_ONE 64  /* of a DN, in the guide to be filtered */

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

/* nearer = min_3x3(u), guide[colour] = A; where the bilateral filter follows and there is noise, it goes to `noisy`, from
 * which that reads it. All sides are mirrored, before and after. Work-items (1, low height). */
__kernel void blend_planes(__global const short *small, __global const float *u, __global const Noise *noise,
                           __global float *nearer, __global float *guide, __global short *noisy, int is_filtered,
                           int width, int stride, int planes)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t row = (size_t)y * stride + SIDE, picture = (size_t)height * stride;
    const float s = 0.6f + 0.3f * noise->t, steepness = -1.0f / (2.0f * s * s), reach = REACH * s;
    __global const float *above = u + (size_t)reflect(y - 1, height) * stride + SIDE, *here = u + row,
                         *below = u + (size_t)reflect(y + 1, height) * stride + SIDE;
    __global float *out = guide + row;
    __global short *noisy_out = noisy + row;
    const int is_noisy = is_filtered && noise->sigma > DENOISED;
    for (int x = 0; x < width; x += 16) {
        float16 position = INFINITY;
        UNROLL
        for (int i = -1; i <= 1; i++)
            position = min(min(position, READ_WIDE(above + x + i)),
                           min(READ_WIDE(here + x + i), READ_WIDE(below + x + i)));
        WIDE(nearer + row + x) = position;

        float16 weights = 0.0f, red = 0.0f, green = 0.0f, blue = 0.0f;
        for (int z = 0; z < planes; z++) {
            const float16 distance = z - position;
            if (!any_of(fabs(distance) < reach))
                continue;
            const float16 weight = quick_exp(steepness * distance * distance);
            __global const short *cells = small + 3 * z * picture + row + x;
            weights += weight;
            red += weight * READ_WIDE_SHORTS(cells);
            green += weight * READ_WIDE_SHORTS(cells + picture);
            blue += weight * READ_WIDE_SHORTS(cells + 2 * picture);
        }
        const float16 unit = 1.0f / (COLOUR_ONE * weights);
        const float16 colours[3] = {red * unit, green * unit, blue * unit};
        UNROLL
        for (int colour = 0; colour < 3; colour++)
            if (is_noisy)
                SHORTS(noisy_out + colour * picture + x) = to_wide_shorts(NOISY_ONE * colours[colour]);
            else
                WIDE(out + colour * picture + x) = colours[colour];
    }
    mirror_ends(nearer + row, width);
    for (int colour = 0; colour < 3; colour++)
        if (is_noisy)
            mirror_short_ends(noisy_out + colour * picture, width);
        else
            mirror_ends(out + colour * picture, width);
}

#define RADIUS 4
#define FARTHEST (RADIUS * RADIUS)

/* 32768 exp(-d^2 / (2 2^2)) by d^2. */
__constant ushort nearness[FARTHEST + 1] = {32767, 28917, 25519, 22520, 19874, 17539, 15478, 13659, 12054,
                                            10638, 9388,  8285,  7311,  6452,  5694,  5025,  4435};

/* Products of what varies / 65536, rounded down. */
#define PRODUCT(a, b) convert_ushort16((convert_uint16(a) * convert_uint16(b)) >> 16u)
#define SIGNED_PRODUCT(a, b) convert_short16((convert_int16(a) * convert_int16(b)) >> 16)

INLINE ushort16 magnitude(short16 v)
{
    return as_ushort16(max(v, -v));
}

/* e that weighs nothing, without the bits too many to be multiplied, and what makes 65536 of it. */
typedef struct {
    ushort limit, spare_bits, steepness;
} Range;

INLINE Range range_of(float sigma, int scale)
{
    const float limit = min(4.0f * NOISY_ONE * 4.0f * sigma / scale, 16383.0f);
    Range range = {(ushort)limit, (ushort)max(ilogb(limit) - 7, 0), 0};
    range.steepness = (ushort)(65535.0f * (1 << range.spare_bits) / limit);
    return range;
}

/* (1 - (e / (4 range))^2)^8 times the nearness, in 1/32768. */
INLINE ushort16 weight_of(ushort16 e, Range range, ushort near)
{
    const ushort16 share = (min(e, (ushort16)range.limit) >> range.spare_bits) * range.steepness;
    ushort16 weight = (ushort16)65535 - PRODUCT(share, share);
    weight = PRODUCT(weight, weight);
    weight = PRODUCT(weight, weight);
    weight = PRODUCT(weight, weight);
    return PART_OF(weight, near);
}

/* Bilateral filter of radius 4: weights exp(-d^2 / (2 2^2)) (1 - (e / (4 range))^2)^8, which is nearly
 * exp(-d^2 / (2 2^2) - e^2 / (2 range^2)), e = |dA|_1. The sides of `noisy` are mirrored, and those of `denoised` after.
 * Work-items (1, low height).
 *
 * Weights add up in 1/2048, differences times weights in 1/(NOISY_ONE / 2) DN: what is rounded down there is taken from
 * the other side for the half of the cells. */
__kernel void denoise(__global const short *noisy, __global const Noise *noise, __global float *denoised, int width,
                      int stride, int scale)
{
    if (noise->sigma <= DENOISED)
        return;
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t picture = (size_t)height * stride, row = (size_t)y * stride + SIDE;
    const Range range = range_of(noise->sigma, scale);
    for (int x = 0; x < width; x += 16) {
        short16 here[3], sums[3];
        UNROLL
        for (int colour = 0; colour < 3; colour++) {
            here[colour] = READ_SHORTS(noisy + colour * picture + row + x);
            sums[colour] = 0;
        }
        ushort16 weights = 2048;
        UNROLL
        for (int j = -RADIUS; j <= RADIUS; j++) {
            __global const short *there = noisy + (size_t)reflect(y + j, height) * stride + SIDE + x;
            UNROLL
            for (int i = -RADIUS; i <= RADIUS; i++) {
                if (i * i + j * j > FARTHEST || (i == 0 && j == 0))
                    continue;
                const bool is_before = j < 0 || (j == 0 && i < 0);
                short16 differences[3];
                ushort16 e = 0;
                UNROLL
                for (int colour = 0; colour < 3; colour++) {
                    const short16 other = READ_SHORTS(there + colour * picture + i);
                    differences[colour] = is_before ? here[colour] - other : other - here[colour];
                    e += magnitude(differences[colour]);
                }
                const ushort16 weight = weight_of(e, range, nearness[i * i + j * j]);
                weights += weight >> (ushort)4;
                UNROLL
                for (int colour = 0; colour < 3; colour++) {
                    const short16 part = SIGNED_PRODUCT(differences[colour], as_short16(weight));
                    sums[colour] += is_before ? -part : part;
                }
            }
        }
        const float16 unit = 2.0f * 2048.0f / NOISY_ONE / convert_float16(convert_int16(weights));
        UNROLL
        for (int colour = 0; colour < 3; colour++)
            WIDE(denoised + colour * picture + row + x) =
                convert_float16(here[colour]) / NOISY_ONE + unit * convert_float16(sums[colour]);
    }
    for (int colour = 0; colour < 3; colour++)
        mirror_ends(denoised + colour * picture + row, width);
}
