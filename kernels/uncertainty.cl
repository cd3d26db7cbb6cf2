/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * One standard deviation of u, in planes:
 *
 *     s = LEVEL OF_NOISE^t (r + .05)^OF_RANGE (h + .01)^OF_ROUGHNESS (f + .03)^OF_FILL (p + .02)^OF_PLACE
 *         (min(m, 2) / (c + .02) + .01)^OF_MARGIN OF_NOTHING^n planes^OF_PLANES
 *
 * r, h and p are of the 3x3 cells around. r: by how much u differs there, as it does in noise and beside depth edges; h: how far
 * u is in the mean from that of its four neighbours, as it is not on a slant; p: how far in the mean u was taken, to its place
 * between planes, from what the matching decided. f: how far the fill took u from what was decided. c: the mean of the filtered
 * cost C over the planes, and m by how much it is higher, two planes and more away from its least, than there: next to nothing
 * where there is no texture, and little where two surfaces are seen.
 * n = max(0, 1 - 10 w), w the evidence that the fill found around, in parts of the square of the high confidence. The numbers
 * are fitted such that 68 % of pixels lie within s and 95 % within 2 s: README.md says on what.
 */
#include "low_picture.cl"

#define LOG_LEVEL 2.659f
#define LOG_OF_NOISE 0.491f
#define OF_RANGE 0.207f
#define OF_ROUGHNESS 0.296f
#define OF_FILL 0.451f
#define OF_PLACE 0.514f
#define OF_MARGIN -0.343f
#define LOG_OF_NOTHING 1.103f
#define OF_PLANES -0.401f

/* log(x) of x > 0, to 0.01: a parabola on the mantissa. */
INLINE float8 quick_log(float8 x)
{
    const int8 bits = as_int8(x);
    const float8 mantissa = as_float8((bits & 0x7fffff) | 0x3f800000);
    return 0.69314718f * (convert_float8((bits >> 23) - 127) - 1.65871022f + mantissa * (2.0f - 0.33582878f * mantissa));
}

/* How far u may differ around. The sides of u are mirrored. */
INLINE float8 range_around(__global const float *u, int x, int y, int height, int stride)
{
    float8 least = INFINITY, most = -INFINITY;
    for (int j = -1; j <= 1; j++) {
        __global const float *cells = u + (size_t)reflect(y + j, height) * stride + SIDE + x;
        UNROLL
        for (int i = -1; i <= 1; i++) {
            least = min(least, READ_CELLS(cells + i));
            most = max(most, READ_CELLS(cells + i));
        }
    }
    return most - least;
}

/* h. The sides of u are mirrored. */
INLINE float8 roughness_around(__global const float *u, int x, int y, int height, int stride)
{
    __global const float *rows[5];
    UNROLL
    for (int j = 0; j < 5; j++)
        rows[j] = u + (size_t)reflect(y + j - 2, height) * stride + SIDE + x;
    float8 sum = 0.0f;
    for (int j = 1; j <= 3; j++)
        UNROLL
        for (int i = -1; i <= 1; i++) {
            const float8 beside = READ_CELLS(rows[j] + i - 1) + READ_CELLS(rows[j] + i + 1);
            const float8 above_below = READ_CELLS(rows[j - 1] + i) + READ_CELLS(rows[j + 1] + i);
            sum += fabs(0.25f * (beside + above_below) - READ_CELLS(rows[j] + i));
        }
    return sum * (1.0f / 9);
}

/* p. The sides of both are mirrored. */
INLINE float8 place_around(__global const float *decided, __global const float *matched, int x, int y, int height, int stride)
{
    float8 sum = 0.0f;
    for (int j = -1; j <= 1; j++) {
        const size_t cells = (size_t)reflect(y + j, height) * stride + SIDE + x;
        UNROLL
        for (int i = -1; i <= 1; i++)
            sum += fabs(READ_CELLS(decided + cells + i) - READ_CELLS(matched + cells + i));
    }
    return sum * (1.0f / 9);
}

/* m / (c + .02), m up to 2. */
INLINE float8 margin_of(__global const short *cells, size_t plane, int planes)
{
    short8 least = SHRT_MAX, best = 0, rival = 2 * COST_ONE;
    int8 sum = 0;
    for (int z = 0; z < planes; z++) {
        const short8 cost = READ_HALF_SHORTS(cells + z * plane);
        best = select(best, (short8)(short)z, cost < least);
        least = min(least, cost);
        sum += convert_int8(cost);
    }
    for (int z = 0; z < planes; z++) {
        const short8 margin = READ_HALF_SHORTS(cells + z * plane) - least;
        rival = select(rival, min(rival, margin), abs(best - (short8)(short)z) > (ushort8)1);
    }
    const float8 mean = clamp(convert_float8(sum) * (1.0f / COST_ONE / planes), 0.0f, 1.0f);
    return convert_float8(rival) * (1.0f / COST_ONE) / (mean + 0.02f);
}

/* deviation = s, its sides mirrored. u: the final one; decided: before the fill; matched: before its place between planes;
 * pair: what the fill solved, its evidence second; cost: filtered. Work-items (1, low height). */
__kernel void low_deviation(__global const float *u, __global const float *decided, __global const float *matched,
                            __global const float *pair, __global const float *high_confidence, __global const short *cost,
                            __global const Noise *noise, __global float *deviation, int width, int stride, int planes)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t row = (size_t)y * stride + SIDE, plane = (size_t)height * stride;
    const float least = 0.1f * *high_confidence * *high_confidence;
    const float of_stack = LOG_LEVEL + LOG_OF_NOISE * noise->t + OF_PLANES * log((float)planes);
    for (int x = 0; x < width; x += 8) {
        const float8 nothing = max(1.0f - READ_CELLS(pair + plane + row + x) / max(least, 1e-6f), 0.0f);
        const float8 range = range_around(u, x, y, height, stride);
        const float8 filled = fabs(READ_CELLS(u + row + x) - READ_CELLS(decided + row + x));
        const float8 rough = roughness_around(u, x, y, height, stride);
        const float8 place = place_around(decided, matched, x, y, height, stride);
        const float8 power = of_stack + OF_RANGE * quick_log(range + 0.05f) + OF_ROUGHNESS * quick_log(rough + 0.01f) +
                             OF_FILL * quick_log(filled + 0.03f) + OF_PLACE * quick_log(place + 0.02f) +
                             OF_MARGIN * quick_log(margin_of(cost + row + x, plane, planes) + 0.01f) +
                             LOG_OF_NOTHING * nothing;
        CELLS(deviation + row + x) = min(quick_exp(power), planes - 1.0f);
    }
    mirror_ends(deviation + row, width);
}

/* Bilinear at full resolution, in steps of the depth map: slopes holds how many of them a plane is at each depth. At least 1;
 * 0 where there is no depth. Work-items (1, height). */
__kernel void upsample_deviation(__global const float *deviation, __global const ushort *depth,
                                 __global const float *slopes, __global ushort *upsampled, int width, int low_height,
                                 int stride)
{
    const int y = (int)get_global_id(1);
    const float fy = (y + 0.5f) / SCALE - 0.5f, low_y = floor(fy);
    __global const float *upper = deviation + (size_t)reflect((int)low_y, low_height) * stride + SIDE;
    __global const float *lower = deviation + (size_t)reflect((int)low_y + 1, low_height) * stride + SIDE;
    for (int x = 0; x < width; x++) {
        const float fx = (x + 0.5f) / SCALE - 0.5f;
        const int low_x = (int)floor(fx);
        const float planes = mix(mix(upper[low_x], upper[low_x + 1], fx - low_x),
                                 mix(lower[low_x], lower[low_x + 1], fx - low_x), fy - low_y);
        const ushort code = depth[(size_t)y * width + x];
        upsampled[(size_t)y * width + x] =
            code == 0 ? 0 : (ushort)(int)clamp(planes * slopes[code] + 0.5f, 1.0f, 65535.0f);
    }
}
