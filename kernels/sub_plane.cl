/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Where between the planes a cell lies, from focus H on the scale where a plane is about two cells of blur. Beside
 * its peak focus falls as 1 / |z - u|, so that a parabola through H comes to a point at the planes and one through 1/H does
 * not: with k the plane nearest to u, v its vertex over k - 1, k, k + 1,
 *
 *     u <- u + (1 - .6t) (v - u)   where it opens upwards and lies within half a plane of u
 *
 * Where planes differ by less blur than even the finest scale shows, k and its neighbour are equally sharp wherever u lies
 * between them, and v would lie half way: there the planes are k - apart, k, k + apart.
 *
 * Where depth steps by more than a plane around, as far as H is blurred, H mixes two surfaces: there v must lie within a
 * quarter of a plane.
 *
 * H is less its floor, the 10th percentile of min_z H and at most .8 + .2t of the least of the three, and at least
 * a fiftieth of the greatest.
 */
#include "low_picture.cl"

#define LEAST_SHARE 0.02f

/* H of a coarser scale at cell (x, y) of this one, bilinear. */
INLINE float coarser_at(__global const short *focus, float x, float y, int height, int stride)
{
    const int left = (int)floor(x), top = (int)floor(y);
    __global const short *upper = focus + (size_t)reflect(top, height) * stride + SIDE + left;
    __global const short *lower = focus + (size_t)reflect(top + 1, height) * stride + SIDE + left;
    const float start = mix((float)upper[0], (float)upper[1], x - left), end = mix((float)lower[0], (float)lower[1], x - left);
    return mix(start, end, y - top);
}

INLINE float16 refined(float16 u, float16 before, float16 here, float16 after, float16 middle, int apart, float16 most, float floor, float t)
{
    const float most_floor = 0.8f + 0.2f * t, trust = 1.0f - 0.6f * t;
    const float16 own_floor = min(most_floor * min(min(before, here), after), floor);
    const float16 highest = max(max(max(before, here), after) - own_floor, 1.0f), least = LEAST_SHARE * highest;
    const float16 a = highest / max(before - own_floor, least), b = highest / max(here - own_floor, least),
                  c = highest / max(after - own_floor, least);
    const float16 bend = a - 2.0f * b + c;
    const float16 vertex = middle + 0.5f * apart * (a - c) / max(bend, 1e-4f);
    const int16 is_one = bend > 1e-4f && fabs(vertex - u) <= most;
    return is_one ? u + trust * (vertex - u) : u;
}

/* How far a vertex may lie from u: of 3x3 cells, `spacing` apart. The sides of u are mirrored. */
INLINE float16 most_way(__global const float *u, int x, int y, int spacing, int height, int stride)
{
    float16 least = INFINITY, greatest = -INFINITY;
    for (int j = -1; j <= 1; j++) {
        __global const float *cells = u + (size_t)reflect(y + j * spacing, height) * stride + SIDE + x;
        UNROLL
        for (int i = -1; i <= 1; i++) {
            const float16 other = READ_WIDE(cells + i * spacing);
            least = min(least, other);
            greatest = max(greatest, other);
        }
    }
    return select((float16)0.5f, (float16)0.25f, greatest - least > 1.0f);
}

/* placed: u so moved, its sides mirrored; focus: of a scale `factor` times as coarse. Work-items (1, low height). */
__kernel void refine(__global const short *focus, __global const float *floor, __global const Noise *noise,
                     __global const float *u, __global float *placed, int factor, int apart, int width, int stride, int planes, int focus_height, int focus_stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1), spacing = min(2 * factor, 8);
    const size_t row = (size_t)y * stride + SIDE, plane = (size_t)focus_height * focus_stride;
    for (int x = 0; x < width; x += 16) {
        const float16 position = READ_WIDE(u + row + x);
        const float16 middle = clamp(rint(position), (float16)(float)apart, (float16)(float)(planes - 1 - apart));
        float16 before = 0.0f, here = 0.0f, after = 0.0f;
        if (factor == 1) {
            __global const short *cells = focus + row + x;
            for (int z = 0; z < planes; z++) {
                const float16 current = READ_WIDE_SHORTS(cells + z * plane), beyond = (float16)(float)z - middle;
                before = beyond == (float16)(float)-apart ? current : before;
                here = beyond == (float16)0.0f ? current : here;
                after = beyond == (float16)(float)apart ? current : after;
            }
        } else {
            float lanes[3][16], middles[16];
            vstore16(middle, 0, middles);
            for (int i = 0; i < 16; i++)
                for (int k = 0; k < 3; k++)
                    lanes[k][i] = coarser_at(focus + ((size_t)middles[i] + (k - 1) * apart) * plane, (min(x + i, width - 1) + 0.5f) / factor - 0.5f,
                                             (y + 0.5f) / factor - 0.5f, focus_height, focus_stride);
            before = vload16(0, lanes[0]);
            here = vload16(0, lanes[1]);
            after = vload16(0, lanes[2]);
        }
        WIDE(placed + row + x) = clamp(refined(position, before, here, after, middle, apart, most_way(u, x, y, spacing, height, stride), *floor, noise->t), 0.0f, planes - 1.0f);
    }
    mirror_ends(placed + row, width);
}

#define REACH 2 /* cells */

/* What noise has moved to and fro is evened out: u is the mean of 5x5 cells, weighted by max(0, 1 - |placed' - placed|), so
 * that steps in depth stay. Work-items (1, low height). */
__kernel void even_out(__global const float *placed, __global float *u, int width, int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    for (int x = 0; x < width; x += 16) {
        const float16 own = READ_WIDE(placed + (size_t)y * stride + SIDE + x);
        float16 sum = 0.0f, weights = 0.0f;
        for (int j = -REACH; j <= REACH; j++) {
            __global const float *cells = placed + (size_t)reflect(y + j, height) * stride + SIDE + x;
            UNROLL
            for (int i = -REACH; i <= REACH; i++) {
                const float16 other = READ_WIDE(cells + i);
                const float16 weight = max(1.0f - fabs(other - own), 0.0f);
                sum += weight * other;
                weights += weight;
            }
        }
        WIDE(u + (size_t)y * stride + SIDE + x) = sum / weights;
    }
    mirror_ends(u + (size_t)y * stride + SIDE, width);
}
