/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * One standard deviation of u, in planes:
 *
 *     s = LEVEL OF_NOISE^t (r + .05)^OF_RANGE (f + .03)^OF_FILL (min(m, 2) / (c + .02) + .01)^OF_MARGIN OF_NOTHING^n
 *
 * r: by how much u differs in the 3x3 cells around, as it does in noise and beside depth edges; f: how far the fill took u
 * from what was decided; c: the mean of the filtered cost C over the planes, and m by how much it is higher, two planes and
 * more away from its least, than there: next to nothing where there is no texture, and little where two surfaces are seen;
 * n = max(0, 1 - 10 w), w the evidence that the fill found around, in parts of the square of the high confidence. The numbers
 * are fitted such that 68 % of pixels lie within s and 95 % within 2 s: README.md says on what.
 */
#include "low_picture.cl"

#define LOG_LEVEL -0.54f
#define LOG_OF_NOISE 0.456f
#define OF_RANGE 0.439f
#define OF_FILL 0.335f
#define OF_MARGIN -0.351f
#define LOG_OF_NOTHING 0.927f

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

/* deviation = s, its sides mirrored. u: the final one; decided: before the fill; pair: what the fill
 * solved, its evidence second; cost: filtered. Work-items (1, low height). */
__kernel void low_deviation(__global const float *u, __global const float *decided, __global const float *pair,
                            __global const float *high_confidence, __global const short *cost,
                            __global const Noise *noise, __global float *deviation, int width, int stride, int planes)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t row = (size_t)y * stride + SIDE, plane = (size_t)height * stride;
    const float least = 0.1f * *high_confidence * *high_confidence;
    for (int x = 0; x < width; x += 8) {
        const float8 nothing = max(1.0f - READ_CELLS(pair + plane + row + x) / max(least, 1e-6f), 0.0f);
        const float8 range = range_around(u, x, y, height, stride);
        const float8 filled = fabs(READ_CELLS(u + row + x) - READ_CELLS(decided + row + x));
        const float8 power = LOG_LEVEL + LOG_OF_NOISE * noise->t + OF_RANGE * quick_log(range + 0.05f) +
                             OF_FILL * quick_log(filled + 0.03f) +
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
